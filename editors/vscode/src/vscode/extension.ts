import { commands, type ExtensionContext, languages, type TextDocument, Uri, window, workspace } from "vscode";
import { DESCRIPTION_DOCUMENTS, DOCUMENTS, WATCHED_PATTERN } from "../server/documents.js";
import { offerInstallation } from "./installation.js";
import { getSelectedPythonEvent } from "./python.js";
import { SHOW_REFERENCES, showReferences } from "./references.js";
import { showRobot } from "./robot.js";
import { hasRosPackage } from "./ros.js";
import { Server } from "./server.js";
import { INTERPRETER } from "./settings.js";

let server: Server | undefined;

/** Called by VS Code at the first activation event of `package.json`. */
export function activate(context: ExtensionContext): void {
  const output = window.createOutputChannel("Linkwright", { log: true });
  const watcher = workspace.createFileSystemWatcher(WATCHED_PATTERN);
  const languageServer = new Server({ output, watcher }, (search) => {
    void offerInstallation(search, () => void languageServer.restart());
  });
  server = languageServer;
  context.subscriptions.push(
    output,
    watcher,
    commands.registerCommand("linkwright.openInPage", (uri?: Uri | string) =>
      showRobot(languageServer, typeof uri === "string" ? Uri.parse(uri, true) : uri), // a code lens passes a string
    ),
    commands.registerCommand(SHOW_REFERENCES, showReferences),
    commands.registerCommand("linkwright.restartServer", () => languageServer.restart()),
    commands.registerCommand("linkwright.showOutput", () => output.show()),
  );
  startWithFirstDocument(languageServer, context);
}

/** Called by VS Code when the window closes. */
export function deactivate(): Promise<void> | undefined {
  return server?.stop();
}

/**
 * Start the server when the first description is opened or, in a workspace with a ROS package, the first other document of
 * the server. Without this distinction, the YAML file of a web program would make the extension offer an installation.
 */
function startWithFirstDocument(languageServer: Server, context: ExtensionContext): void {
  let isStarted = false;
  const start = async (): Promise<void> => {
    if (isStarted) return;
    isStarted = true;
    await languageServer.start();
    await followPython(languageServer, context);
  };
  const onDocumentOpened = async (document: TextDocument): Promise<void> => {
    if (isStarted || languages.match(DOCUMENTS, document) === 0) return;
    if (languages.match(DESCRIPTION_DOCUMENTS, document) > 0 || (await hasRosPackage())) await start();
  };
  context.subscriptions.push(workspace.onDidOpenTextDocument((document) => void onDocumentOpened(document)));
  workspace.textDocuments.forEach((document) => void onDocumentOpened(document));
}

/** Search for Linkwright again when the user selects another Python. */
async function followPython(languageServer: Server, context: ExtensionContext): Promise<void> {
  const onPythonSelected = await getSelectedPythonEvent();
  if (onPythonSelected !== undefined) context.subscriptions.push(onPythonSelected(() => void languageServer.refresh()));
  context.subscriptions.push(
    workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration(INTERPRETER)) void languageServer.restart();
    }),
  );
}
