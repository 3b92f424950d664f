import { posix, win32 } from "node:path";
import { type Command, moduleCommandFor } from "./command.js";

/** The places where Linkwright may be installed; tests pass their own. */
export interface Places {
  /** The setting `linkwright.interpreter`; empty if it is not set. */
  readonly interpreter: string;
  /** The paths of the workspace's folders. */
  readonly folders: readonly string[];
  readonly home: string;
  readonly isWindows: boolean;
  exists(file: string): boolean;
  /** Return the interpreter selected in the Python extension; undefined if the extension is not installed. */
  getSelectedPython(): Promise<string | undefined>;
  /** Return the path of a program on the PATH. */
  findOnPath(program: string): string | undefined;
}

/** A command that may be able to run the language server. */
export interface Candidate {
  readonly command: Command;
  /** The interpreter of the command; absent for a program on the PATH, beside which nothing must be installed. */
  readonly python?: string;
}

const ENVIRONMENTS = [".venv", "venv"];

/** Yield the commands to try, in order of preference. If an interpreter is set, it is the only one. */
export async function* findCandidates(places: Places): AsyncGenerator<Candidate> {
  if (places.interpreter !== "") {
    yield candidateFor(resolvePath(places.interpreter, places));
    return;
  }
  for (const folder of places.folders) {
    for (const environment of ENVIRONMENTS) {
      const python = pythonPathOf(folder, environment, places);
      if (places.exists(python)) yield candidateFor(python);
    }
  }
  const selectedPython = await places.getSelectedPython();
  if (selectedPython !== undefined) yield candidateFor(selectedPython);
  const program = places.findOnPath("linkwright");
  if (program !== undefined) yield { command: { program, args: [] } };
}

function candidateFor(python: string): Candidate {
  return { command: moduleCommandFor(python), python };
}

function pythonPathOf(workspaceFolder: string, environment: string, places: Places): string {
  return places.isWindows
    ? win32.join(workspaceFolder, environment, "Scripts", "python.exe")
    : posix.join(workspaceFolder, environment, "bin", "python");
}

/** Return the path that a setting means. VS Code does not resolve variables, `~` and relative paths in settings. */
export function resolvePath(setting: string, places: Pick<Places, "folders" | "home" | "isWindows">): string {
  const paths = places.isWindows ? win32 : posix;
  const folder = places.folders[0] ?? places.home;
  const path = setting
    .trim()
    .replaceAll("${workspaceFolder}", folder)
    .replace(/^~(?=[/\\])/, places.home);
  return paths.isAbsolute(path) || !/[/\\]/.test(path) ? path : paths.join(folder, path);
}
