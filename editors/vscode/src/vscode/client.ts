import type { FileSystemWatcher, LogOutputChannel } from "vscode";
import { LanguageClient, type StaticFeature } from "vscode-languageclient/node";
import { type Command, environment, extended } from "../server/command.js";
import { SHOW_REFERENCES } from "./references.js";
import { DOCUMENTS } from "../server/documents.js";

/** What clients share. */
export interface Shared {
  readonly output: LogOutputChannel;
  /** Tells of changes on the disk. */
  readonly watcher: FileSystemWatcher;
}

/** Return a client of the language server that a command runs. It is not started. */
export function makeClient(command: Command, cwd: string | undefined, { output, watcher }: Shared): LanguageClient {
  const { program, args } = extended(command, "lsp");
  const options = { env: environment(), ...(cwd === undefined ? {} : { cwd }) };
  const client = new LanguageClient(
    "linkwright", // the prefix of the setting linkwright.trace.server
    "Linkwright",
    { command: program, args: [...args], options },
    { documentSelector: DOCUMENTS, outputChannel: output, synchronize: { fileEvents: watcher } },
  );
  client.registerFeature(lensCommands);
  return client;
}

/** Announces the commands of code lenses, which the server offers to clients that have them. */
const lensCommands: StaticFeature = {
  fillClientCapabilities: (capabilities) => {
    capabilities.experimental = { commands: [SHOW_REFERENCES, "linkwright.openInPage"] };
  },
  initialize: () => undefined,
  getState: () => ({ kind: "static" }),
  clear: () => undefined,
};
