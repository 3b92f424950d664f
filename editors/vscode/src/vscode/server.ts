import { ExecuteCommandRequest, type LanguageClient } from "vscode-languageclient/node";
import type { Candidate } from "../server/candidates.js";
import { appendArguments, formatCommand } from "../server/command.js";
import { findServer, type Search } from "../server/finder.js";
import { probe } from "../server/probe.js";
import { createClient, type SharedResources } from "./client.js";
import { createPlaces, listFolders } from "./places.js";

/** The command of the language server that serves the page of a robot. */
const SHOW_ROBOT = "linkwright.showRobot";

/** The language server of this window. */
export class Server {
  private client: LanguageClient | undefined;
  private candidate: Candidate | undefined;
  private lastOperation: Promise<unknown> = Promise.resolve();

  /** @param onNotFound called with a search that found no server. */
  constructor(
    private readonly resources: SharedResources,
    private readonly onNotFound: (search: Search) => void,
  ) {}

  /** Start the server unless it runs; return its candidate, or undefined if no server was found. */
  start(): Promise<Candidate | undefined> {
    return this.runInTurn(async () => {
      if (this.candidate === undefined) await this.startCandidate(await this.search(this.onNotFound));
      return this.candidate;
    });
  }

  /**
   * Return the address of a robot's page, which follows the documents and the cursor of VS Code.
   *
   * @returns undefined if no server was found; `onNotFound` was called.
   */
  async requestRobotAddress(uri: string): Promise<string | undefined> {
    await this.start();
    return this.client?.sendRequest(ExecuteCommandRequest.type, { command: SHOW_ROBOT, arguments: [uri, false] }) as
      | Promise<string>
      | undefined;
  }

  /** Stop the server, search for Linkwright again, and start the server that was found. */
  restart(): Promise<void> {
    return this.runInTurn(async () => {
      await this.stopNow();
      await this.startCandidate(await this.search(this.onNotFound));
    });
  }

  /** Search for Linkwright again; if the search finds another one, replace the server by that of the other one. */
  refresh(): Promise<void> {
    return this.runInTurn(async () => {
      const candidate = await this.search(() => undefined);
      if (candidate === undefined) return;
      if (this.candidate !== undefined && formatCandidate(candidate) === formatCandidate(this.candidate)) return;
      await this.stopNow();
      await this.startCandidate(candidate);
    });
  }

  /** Stop the server. */
  stop(): Promise<void> {
    return this.runInTurn(() => this.stopNow());
  }

  private async search(onNotFound: (search: Search) => void): Promise<Candidate | undefined> {
    const search = await findServer(createPlaces(), (command) => probe(command, listFolders()[0]));
    for (const { candidate, reason } of search.failures) this.resources.output.warn(`${formatCandidate(candidate)}: ${reason}`);
    if (search.candidate === undefined) onNotFound(search);
    return search.candidate;
  }

  private async startCandidate(candidate: Candidate | undefined): Promise<void> {
    if (candidate === undefined) return;
    this.resources.output.info(formatCandidate(candidate));
    this.candidate = candidate;
    this.client = createClient(candidate.command, listFolders()[0], this.resources);
    try {
      await this.client.start();
    } catch (error) {
      this.resources.output.error(`${formatCandidate(candidate)}: ${String(error)}`); // the client has shown the error to the user
    }
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    this.candidate = undefined;
    try {
      await client?.dispose();
    } catch (error) {
      this.resources.output.warn(String(error)); // the server had not started, or had ended by itself
    }
  }

  /** Run an operation after the earlier ones have ended, so that two clients never start at once. */
  private runInTurn<T>(operation: () => Promise<T>): Promise<T> {
    const result = this.lastOperation.then(operation);
    this.lastOperation = result.catch(() => undefined);
    return result;
  }
}

function formatCandidate({ command }: Candidate): string {
  return formatCommand(appendArguments(command, "lsp"));
}
