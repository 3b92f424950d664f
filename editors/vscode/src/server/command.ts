/** A program with its first arguments, which runs Linkwright. */
export interface Command {
  readonly program: string;
  readonly args: readonly string[];
}

/** Return the command that runs the Linkwright of a Python. */
export function moduleOf(python: string): Command {
  return { program: python, args: ["-m", "linkwright"] };
}

/** Return the command with more arguments. */
export function extended(command: Command, ...args: readonly string[]): Command {
  return { program: command.program, args: [...command.args, ...args] };
}

/** Return the command as text for people. It is not quoted for a shell. */
export function shown(command: Command): string {
  return [command.program, ...command.args].join(" ");
}

/**
 * Return the environment for Linkwright's processes.
 *
 * `python -m` imports from the working directory first; a file `queue.py` in the workspace would break Linkwright.
 * Python 3.10 does not know this variable.
 */
export function environment(): NodeJS.ProcessEnv {
  return { ...process.env, PYTHONSAFEPATH: "1" };
}
