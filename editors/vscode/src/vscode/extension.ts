import { commands, type ExtensionContext, languages, type TextDocument, Uri, window, workspace } from "vscode";
import { DOCUMENTS, OF_ROBOTS, WATCHED } from "../server/documents.js";
import { offerInstallation } from "./installation.js";
import { selectedPythonChanged } from "./python.js";
import { SHOW_REFERENCES, showReferences } from "./references.js";
import { showRobot } from "./robot.js";
import { hasRosPackage } from "./ros.js";
import { Server } from "./server.js";
import { INTERPRETER } from "./settings.js";

let server: Server | undefined;

/** Called by VS Code with the first description, in a workspace with a package, or with the first command. */
export function activate(context: ExtensionContext): void {
  const output = window.createOutputChannel("Linkwright", { log: true });
  const watcher = workspace.createFileSystemWatcher(WATCHED);
  const running = new Server({ output, watcher }, (search) => {
    void offerInstallation(search, () => void running.restart());
  });
  server = running;
  context.subscriptions.push(
    output,
    watcher,
    commands.registerCommand("linkwright.openInPage", (uri?: Uri | string) =>
      showRobot(running, typeof uri === "string" ? Uri.parse(uri, true) : uri), // a code lens passes a text
    ),
    commands.registerCommand(SHOW_REFERENCES, showReferences),
    commands.registerCommand("linkwright.restartServer", () => running.restart()),
    commands.registerCommand("linkwright.showOutput", () => output.show()),
  );
  startWithFirstDocument(running, context);
}

/** Called by VS Code when the window closes. */
export function deactivate(): Promise<void> | undefined {
  return server?.stop();
}

/**
 * Start the server with the first description, or with the first other file of a ROS package. Without this distinction,
 * every YAML file of a web program would ask its author to install Linkwright.
 */
function startWithFirstDocument(running: Server, context: ExtensionContext): void {
  let isStarted = false;
  const start = async (): Promise<void> => {
    if (isStarted) return;
    isStarted = true;
    await running.start();
    await followPython(running, context);
  };
  const opened = async (document: TextDocument): Promise<void> => {
    if (isStarted || languages.match(DOCUMENTS, document) === 0) return;
    if (languages.match(OF_ROBOTS, document) > 0 || (await hasRosPackage())) await start();
  };
  context.subscriptions.push(workspace.onDidOpenTextDocument((document) => void opened(document)));
  workspace.textDocuments.forEach((document) => void opened(document));
}

/** Use another Linkwright when the user chooses another Python. */
async function followPython(running: Server, context: ExtensionContext): Promise<void> {
  const selected = await selectedPythonChanged();
  if (selected !== undefined) context.subscriptions.push(selected(() => void running.refresh()));
  context.subscriptions.push(
    workspace.onDidChangeConfiguration((changed) => {
      if (changed.affectsConfiguration(INTERPRETER)) void running.restart();
    }),
  );
}
