/** A program with its first arguments, which runs Linkwright. */
export interface Command {
  readonly program: string;
  readonly args: readonly string[];
}

/** Return the command that runs the Linkwright installed in a Python. */
export function moduleCommandFor(python: string): Command {
  return { program: python, args: ["-m", "linkwright"] };
}

/** Return the command with arguments appended. */
export function appendArguments(command: Command, ...args: readonly string[]): Command {
  return { program: command.program, args: [...command.args, ...args] };
}

/** Return the command as text for messages, not quoted for a shell. */
export function formatCommand(command: Command): string {
  return [command.program, ...command.args].join(" ");
}

/**
 * Return the environment for Linkwright's processes.
 *
 * Without PYTHONSAFEPATH, `python -m` imports from the working directory first: a file `queue.py` in the workspace would
 * break Linkwright. Python 3.10 ignores the variable.
 */
export function createEnvironment(): NodeJS.ProcessEnv {
  return { ...process.env, PYTHONSAFEPATH: "1" };
}
