import { type Candidate, candidates, type Places } from "./candidates.js";
import type { Command } from "./command.js";

/** Returns why a command cannot run the language server; undefined if it can. */
export type Probe = (command: Command) => Promise<string | undefined>;

/** A command that was tried in vain. */
export interface Failure {
  readonly candidate: Candidate;
  readonly reason: string;
}

/** What the search has found: a command, or why there is none. */
export interface Search {
  readonly found: Candidate | undefined;
  readonly failures: readonly Failure[];
}

/** Return the first command that can run the language server. */
export async function findServer(places: Places, probe: Probe): Promise<Search> {
  const failures: Failure[] = [];
  for await (const candidate of candidates(places)) {
    const reason = await probe(candidate.command);
    if (reason === undefined) return { found: candidate, failures };
    failures.push({ candidate, reason });
  }
  return { found: undefined, failures };
}

/** Return the interpreter to install Linkwright into: the first one tried that belongs to the user's project. */
export function installable(search: Search): string | undefined {
  return search.failures.find(({ candidate }) => candidate.python !== undefined)?.candidate.python;
}
