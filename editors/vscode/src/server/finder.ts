import { type Candidate, findCandidates, type Places } from "./candidates.js";
import type { Command } from "./command.js";

/** Returns why a command cannot run the language server; undefined if it can. */
export type Probe = (command: Command) => Promise<string | undefined>;

/** A candidate that cannot run the language server. */
export interface Failure {
  readonly candidate: Candidate;
  readonly reason: string;
}

/** The result of a search. */
export interface Search {
  /** The first candidate that can run the language server; undefined if there is none. */
  readonly candidate: Candidate | undefined;
  /** The candidates tried before it. */
  readonly failures: readonly Failure[];
}

/** Search for the first command that can run the language server. */
export async function findServer(places: Places, probe: Probe): Promise<Search> {
  const failures: Failure[] = [];
  for await (const candidate of findCandidates(places)) {
    const reason = await probe(candidate.command);
    if (reason === undefined) return { candidate, failures };
    failures.push({ candidate, reason });
  }
  return { candidate: undefined, failures };
}

/** Return the interpreter to install Linkwright into: the first one tried; undefined if none was tried. */
export function findInstallTarget(search: Search): string | undefined {
  return search.failures.find(({ candidate }) => candidate.python !== undefined)?.candidate.python;
}
