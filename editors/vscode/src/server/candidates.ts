import { posix, win32 } from "node:path";
import { type Command, moduleOf } from "./command.js";

/** The places where Linkwright may be; tests replace it. */
export interface Places {
  /** The setting `linkwright.interpreter`; empty if it is not set. */
  readonly interpreter: string;
  /** The paths of the workspace's folders. */
  readonly folders: readonly string[];
  readonly home: string;
  readonly isWindows: boolean;
  exists(file: string): boolean;
  /** Return the interpreter that is selected in the Python extension, if that is installed. */
  selectedPython(): Promise<string | undefined>;
  /** Return the path of a program on the PATH. */
  onPath(program: string): string | undefined;
}

/** A command that may be able to run the language server. */
export interface Candidate {
  readonly command: Command;
  /** The interpreter to install Linkwright into; absent where that is not ours to change. */
  readonly python?: string;
}

const ENVIRONMENTS = [".venv", "venv"];

/** Yield the commands to try, the preferred one first. A set interpreter is the only one. */
export async function* candidates(places: Places): AsyncGenerator<Candidate> {
  if (places.interpreter !== "") {
    yield ofPython(resolved(places.interpreter, places));
    return;
  }
  for (const folder of places.folders) {
    for (const environment of ENVIRONMENTS) {
      const python = pythonIn(folder, environment, places);
      if (places.exists(python)) yield ofPython(python);
    }
  }
  const selected = await places.selectedPython();
  if (selected !== undefined) yield ofPython(selected);
  const program = places.onPath("linkwright");
  if (program !== undefined) yield { command: { program, args: [] } };
}

function ofPython(python: string): Candidate {
  return { command: moduleOf(python), python };
}

function pythonIn(folder: string, environment: string, places: Places): string {
  return places.isWindows
    ? win32.join(folder, environment, "Scripts", "python.exe")
    : posix.join(folder, environment, "bin", "python");
}

/** Return the path that a setting means: VS Code leaves variables, `~` and relative paths to extensions. */
export function resolved(setting: string, places: Pick<Places, "folders" | "home" | "isWindows">): string {
  const paths = places.isWindows ? win32 : posix;
  const folder = places.folders[0] ?? places.home;
  const path = setting
    .trim()
    .replaceAll("${workspaceFolder}", folder)
    .replace(/^~(?=[/\\])/, places.home);
  return paths.isAbsolute(path) || !/[/\\]/.test(path) ? path : paths.join(folder, path);
}
