import { commands, type ExtensionContext, languages, type TextDocument, Uri, window, workspace } from "vscode";
import { Views } from "../page/views.js";
import { DOCUMENTS, WATCHED } from "../server/documents.js";
import { offerInstallation } from "./installation.js";
import { selectedPythonChanged } from "./python.js";
import { SHOW_REFERENCES, showReferences } from "./references.js";
import { showRobot } from "./robot.js";
import { Server } from "./server.js";
import { INTERPRETER } from "./settings.js";

let server: Server | undefined;

/** Called by VS Code with the first document in XML, or the first command. */
export function activate(context: ExtensionContext): void {
  const output = window.createOutputChannel("Linkwright", { log: true });
  const watcher = workspace.createFileSystemWatcher(WATCHED);
  const views = new Views((line) => output.info(line));
  const running = new Server({ output, watcher }, (search) => {
    void offerInstallation(search, () => void running.restart());
  });
  server = running;
  context.subscriptions.push(
    output,
    watcher,
    views,
    commands.registerCommand("linkwright.openInPage", (uri?: Uri | string) =>
      showRobot(running, views, typeof uri === "string" ? Uri.parse(uri, true) : uri), // a code lens passes a text
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

/** Start the server with the first document that it can read: other documents in XML activate the extension, too. */
function startWithFirstDocument(running: Server, context: ExtensionContext): void {
  let isStarted = false;
  const opened = (document: TextDocument): void => {
    if (isStarted || languages.match(DOCUMENTS, document) === 0) return;
    isStarted = true;
    void running.start().then(() => followPython(running, context));
  };
  context.subscriptions.push(workspace.onDidOpenTextDocument(opened));
  workspace.textDocuments.forEach(opened);
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
