import { commands, ProcessExecution, Task, TaskRevealKind, tasks, TaskScope, window } from "vscode";
import { shown } from "../server/command.js";
import { installable, type Search } from "../server/finder.js";
import { installCommand } from "../server/requirement.js";
import { INTERPRETER, packageSource } from "./settings.js";

const INSTALL = "Install";
const CHOOSE = "Choose the Python";
const OUTPUT = "Show the Output";

/** Tell the user that there is no language server, and offer to install it; `installed` is called afterwards. */
export async function offerInstallation(search: Search, installed: () => void): Promise<void> {
  const python = installable(search);
  const answer =
    python === undefined
      ? await window.showWarningMessage(
          "Linkwright's language server was not found. Make a virtual environment .venv in the workspace, or choose a Python.",
          CHOOSE,
          OUTPUT,
        )
      : await window.showWarningMessage(
          `Linkwright's language server does not run in ${python}. ${sourceOf(packageSource(), shown(installCommand(python, packageSource())))}`,
          INSTALL,
          CHOOSE,
          OUTPUT,
        );
  if (answer === INSTALL && python !== undefined) await install(python, installed);
  if (answer === CHOOSE) await commands.executeCommand("workbench.action.openSettings", INTERPRETER);
  if (answer === OUTPUT) await commands.executeCommand("linkwright.showOutput");
}

function sourceOf(source: string, command: string): string {
  return source === ""
    ? `Install it with "${command}"? No version is on a public package index yet: this needs an index that has Linkwright, or the path of a checkout in the setting linkwright.package.`
    : `Install it with "${command}"?`;
}

/** Run pip in a terminal. A task needs no quoting for a shell, and tells when it has ended. */
async function install(python: string, installed: () => void): Promise<void> {
  const { program, args } = installCommand(python, packageSource());
  const execution = new ProcessExecution(program, [...args]);
  const task = new Task({ type: "process" }, TaskScope.Workspace, "Install the language server", "Linkwright", execution);
  task.presentationOptions = { reveal: TaskRevealKind.Always };
  const running = await tasks.executeTask(task);
  const listener = tasks.onDidEndTaskProcess(({ execution: ended, exitCode }) => {
    if (ended !== running) return;
    listener.dispose();
    if (exitCode === 0) installed();
  });
}
