import type { FileSystemWatcher, LogOutputChannel } from "vscode";
import { LanguageClient, type StaticFeature } from "vscode-languageclient/node";
import { appendArguments, type Command, createEnvironment } from "../server/command.js";
import { DOCUMENTS } from "../server/documents.js";
import { SHOW_REFERENCES } from "./references.js";

/** The objects that all clients of the window share. */
export interface SharedResources {
  readonly output: LogOutputChannel;
  /** Reports changes of files on the disk. */
  readonly watcher: FileSystemWatcher;
}

/** Return a client, not yet started, of the language server that a command runs. */
export function createClient(command: Command, cwd: string | undefined, { output, watcher }: SharedResources): LanguageClient {
  const { program, args } = appendArguments(command, "lsp");
  const options = { env: createEnvironment(), ...(cwd === undefined ? {} : { cwd }) };
  const client = new LanguageClient(
    "linkwright", // the prefix of the setting linkwright.trace.server
    "Linkwright",
    { command: program, args: [...args], options },
    { documentSelector: DOCUMENTS, outputChannel: output, synchronize: { fileEvents: watcher } },
  );
  client.registerFeature(announceLensCommands);
  return client;
}

/** Tells the server that this client has the commands of its code lenses; without that, it offers no such lenses. */
const announceLensCommands: StaticFeature = {
  fillClientCapabilities: (capabilities) => {
    capabilities.experimental = { commands: [SHOW_REFERENCES, "linkwright.openInPage"] };
  },
  initialize: () => undefined,
  getState: () => ({ kind: "static" }),
  clear: () => undefined,
};
