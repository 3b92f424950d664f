import { ExecuteCommandRequest, type LanguageClient } from "vscode-languageclient/node";
import type { Candidate } from "../server/candidates.js";
import { extended, shown } from "../server/command.js";
import { findServer, type Search } from "../server/finder.js";
import { probe } from "../server/probe.js";
import { makeClient, type Shared } from "./client.js";
import { folders, places } from "./places.js";

/** The command of the language server that serves the page of a robot. */
const SHOW_ROBOT = "linkwright.showRobot";

/** The language server of this window. */
export class Server {
  private client: LanguageClient | undefined;
  private candidate: Candidate | undefined;
  private work: Promise<unknown> = Promise.resolve();

  /** @param notFound is called with a search that found nothing. */
  constructor(
    private readonly shared: Shared,
    private readonly notFound: (search: Search) => void,
  ) {}

  /** Start the server unless it runs; return the command that runs Linkwright, if there is one. */
  start(): Promise<Candidate | undefined> {
    return this.inTurn(async () => {
      if (this.candidate === undefined) await this.startFound(await this.search(this.notFound));
      return this.candidate;
    });
  }

  /**
   * Return the address of the page of a robot, which follows the texts and the cursor of VS Code.
   *
   * @returns undefined if there is no server, which the user has been told.
   */
  async robotAddress(uri: string): Promise<string | undefined> {
    await this.start();
    return this.client?.sendRequest(ExecuteCommandRequest.type, { command: SHOW_ROBOT, arguments: [uri, false] }) as
      | Promise<string>
      | undefined;
  }

  /** Search for Linkwright again, and start its server anew. */
  restart(): Promise<void> {
    return this.inTurn(async () => {
      await this.stopNow();
      await this.startFound(await this.search(this.notFound));
    });
  }

  /** Search for Linkwright again; if another one is found, start its server instead. */
  refresh(): Promise<void> {
    return this.inTurn(async () => {
      const found = await this.search(() => undefined);
      if (found === undefined || (this.candidate && shown(found.command) === shown(this.candidate.command))) return;
      await this.stopNow();
      await this.startFound(found);
    });
  }

  /** Stop the server. */
  stop(): Promise<void> {
    return this.inTurn(() => this.stopNow());
  }

  private async search(notFound: (search: Search) => void): Promise<Candidate | undefined> {
    const search = await findServer(places(), (command) => probe(command, folders()[0]));
    for (const { candidate, reason } of search.failures) this.shared.output.warn(`${lineOf(candidate)}: ${reason}`);
    if (search.found === undefined) notFound(search);
    return search.found;
  }

  private async startFound(found: Candidate | undefined): Promise<void> {
    if (found === undefined) return;
    this.shared.output.info(lineOf(found));
    this.candidate = found;
    this.client = makeClient(found.command, folders()[0], this.shared);
    try {
      await this.client.start();
    } catch (error) {
      this.shared.output.error(`${lineOf(found)}: ${String(error)}`); // the client has shown it, too
    }
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    this.candidate = undefined;
    try {
      await client?.dispose();
    } catch (error) {
      this.shared.output.warn(String(error)); // it had not started, or had ended by itself
    }
  }

  /** Run work after what was asked before, so that no two clients start at once. */
  private inTurn<T>(work: () => Promise<T>): Promise<T> {
    const result = this.work.then(work);
    this.work = result.catch(() => undefined);
    return result;
  }
}

function lineOf({ command }: Candidate): string {
  return shown(extended(command, "lsp"));
}
