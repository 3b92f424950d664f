import { commands, env, ProgressLocation, Uri, window } from "vscode";
import type { Server } from "./server.js";

/** The command that opens VS Code's integrated browser (1.109 and newer). It is not documented. */
const INTEGRATED_BROWSER = "workbench.action.browser.open";

/** Show the robot of a file, by default that of the active editor. */
export async function showRobot(server: Server, chosenUri: Uri | undefined): Promise<void> {
  const uri = chosenUri ?? window.activeTextEditor?.document.uri;
  if (uri?.scheme !== "file") return;
  const progress = { location: ProgressLocation.Window, title: "Linkwright: loading the robot" };
  try {
    const address = await window.withProgress(progress, () => server.requestRobotAddress(uri.toString()));
    if (address !== undefined) await openPage(address);
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    const answer = await window.showErrorMessage(`The robot cannot be shown: ${reason}.`, "Show the Output");
    if (answer !== undefined) await commands.executeCommand("linkwright.showOutput");
  }
}

/**
 * Open the page in VS Code's integrated browser, or in the user's browser if VS Code has none.
 *
 * VS Code's Simple Browser and webviews cannot show it: they put a page into a frame, which Linkwright's page refuses
 * (`frame-ancestors 'none'`).
 */
async function openPage(address: string): Promise<void> {
  const url = Uri.parse(address, true);
  const commandNames = await commands.getCommands(true);
  if (commandNames.includes(INTEGRATED_BROWSER)) {
    const externalUrl = await env.asExternalUri(url); // forwards the port of a remote machine; openExternal does so itself
    await commands.executeCommand(INTEGRATED_BROWSER, externalUrl.toString(true)); // true: the "=" in "?token=" is not encoded
  } else {
    await env.openExternal(url);
  }
}
