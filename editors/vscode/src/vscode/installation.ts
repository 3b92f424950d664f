import { commands, ProcessExecution, Task, TaskRevealKind, tasks, TaskScope, window } from "vscode";
import { formatCommand } from "../server/command.js";
import { findInstallTarget, type Search } from "../server/finder.js";
import { installCommand } from "../server/requirement.js";
import { INTERPRETER, readPackageSource } from "./settings.js";

const INSTALL = "Install";
const CHOOSE_PYTHON = "Choose the Python";
const SHOW_OUTPUT = "Show the Output";

/** Tell the user that no language server was found, and offer to install it; `onInstalled` is called after an installation. */
export async function offerInstallation(search: Search, onInstalled: () => void): Promise<void> {
  const python = findInstallTarget(search);
  const source = readPackageSource();
  const answer =
    python === undefined
      ? await window.showWarningMessage(
          "Linkwright's language server was not found. Make a virtual environment .venv in the workspace, or choose a Python.",
          CHOOSE_PYTHON,
          SHOW_OUTPUT,
        )
      : await window.showWarningMessage(
          `Linkwright's language server does not run in ${python}. ${formatOffer(source, formatCommand(installCommand(python, source)))}`,
          INSTALL,
          CHOOSE_PYTHON,
          SHOW_OUTPUT,
        );
  if (answer === INSTALL && python !== undefined) await install(python, onInstalled);
  if (answer === CHOOSE_PYTHON) await commands.executeCommand("workbench.action.openSettings", INTERPRETER);
  if (answer === SHOW_OUTPUT) await commands.executeCommand("linkwright.showOutput");
}

function formatOffer(source: string, command: string): string {
  return source === ""
    ? `Install it with "${command}"? No version is on a public package index yet: this needs an index that has Linkwright, or the path of a checkout in the setting linkwright.package.`
    : `Install it with "${command}"?`;
}

/** Run pip in a terminal. It runs as a task, which needs no quoting for a shell and has an event for its end. */
async function install(python: string, onInstalled: () => void): Promise<void> {
  const { program, args } = installCommand(python, readPackageSource());
  const execution = new ProcessExecution(program, [...args]);
  const task = new Task({ type: "process" }, TaskScope.Workspace, "Install the language server", "Linkwright", execution);
  task.presentationOptions = { reveal: TaskRevealKind.Always };
  const taskExecution = await tasks.executeTask(task);
  const listener = tasks.onDidEndTaskProcess(({ execution: endedExecution, exitCode }) => {
    if (endedExecution !== taskExecution) return;
    listener.dispose();
    if (exitCode === 0) onInstalled();
  });
}
