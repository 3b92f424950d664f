import { commands, env, ProgressLocation, Uri, window } from "vscode";
import type { Server } from "./server.js";

/** The command of VS Code's integrated browser (1.109 and newer), which is not documented as an interface. */
const INTEGRATED_BROWSER = "workbench.action.browser.open";

/** Show the robot of a file, by default that of the active editor. */
export async function showRobot(server: Server, chosen: Uri | undefined): Promise<void> {
  const uri = chosen ?? window.activeTextEditor?.document.uri;
  if (uri?.scheme !== "file") return;
  const progress = { location: ProgressLocation.Window, title: "Linkwright: loading the robot" };
  try {
    const address = await window.withProgress(progress, () => server.robotAddress(uri.toString()));
    if (address !== undefined) await open(address);
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    const answer = await window.showErrorMessage(`The robot cannot be shown: ${reason}.`, "Show the Output");
    if (answer !== undefined) await commands.executeCommand("linkwright.showOutput");
  }
}

/**
 * Open the page beside the text, else in the user's browser.
 *
 * Neither VS Code's Simple Browser nor a webview can show it: both put pages into frames, which Linkwright's page
 * refuses (`frame-ancestors 'none'`).
 */
async function open(address: string): Promise<void> {
  const url = Uri.parse(address, true);
  const known = await commands.getCommands(true);
  if (known.includes(INTEGRATED_BROWSER)) {
    const here = await env.asExternalUri(url); // forwards the port of a remote machine, as openExternal does itself
    await commands.executeCommand(INTEGRATED_BROWSER, here.toString(true)); // true: the = of ?token= stays
  } else {
    await env.openExternal(url);
  }
}
