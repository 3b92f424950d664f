import { existsSync } from "node:fs";
import { homedir, platform } from "node:os";
import { delimiter, join } from "node:path";
import { workspace } from "vscode";
import type { Places } from "../server/candidates.js";
import { getSelectedPython } from "./python.js";
import { readInterpreter } from "./settings.js";

const IS_WINDOWS = platform() === "win32";

/** Return the places to search on this machine and in this window. */
export function createPlaces(): Places {
  return {
    interpreter: readInterpreter(),
    folders: listFolders(),
    home: homedir(),
    isWindows: IS_WINDOWS,
    exists: existsSync,
    getSelectedPython,
    findOnPath,
  };
}

/** Return the paths of the workspace's folders on the disk. */
export function listFolders(): string[] {
  const workspaceFolders = workspace.workspaceFolders ?? [];
  return workspaceFolders.filter(({ uri }) => uri.scheme === "file").map(({ uri }) => uri.fsPath);
}

function findOnPath(program: string): string | undefined {
  const name = IS_WINDOWS ? `${program}.exe` : program;
  const paths = (process.env["PATH"] ?? "").split(delimiter).filter((folder) => folder !== "");
  return paths.map((folder) => join(folder, name)).find(existsSync);
}
