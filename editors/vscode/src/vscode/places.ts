import { existsSync } from "node:fs";
import { homedir, platform } from "node:os";
import { delimiter, join } from "node:path";
import { workspace } from "vscode";
import type { Places } from "../server/candidates.js";
import { selectedPython } from "./python.js";
import { interpreter } from "./settings.js";

const IS_WINDOWS = platform() === "win32";

/** Return the places of this machine and window. */
export function places(): Places {
  return {
    interpreter: interpreter(),
    folders: folders(),
    home: homedir(),
    isWindows: IS_WINDOWS,
    exists: existsSync,
    selectedPython,
    onPath,
  };
}

/** Return the paths of the workspace's folders on the disk. */
export function folders(): string[] {
  const all = workspace.workspaceFolders ?? [];
  return all.filter(({ uri }) => uri.scheme === "file").map(({ uri }) => uri.fsPath);
}

function onPath(program: string): string | undefined {
  const name = IS_WINDOWS ? `${program}.exe` : program;
  const paths = (process.env["PATH"] ?? "").split(delimiter).filter((folder) => folder !== "");
  return paths.map((folder) => join(folder, name)).find(existsSync);
}
