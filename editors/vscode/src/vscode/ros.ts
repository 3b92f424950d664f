import { workspace } from "vscode";
import { isRosManifest, MANIFEST_PATTERN } from "../server/documents.js";

const EXCLUDED_FOLDERS = "**/{node_modules,build,install,log,.venv,venv}/**";
const MAX_MANIFESTS = 20;

/** Return whether a folder of the workspace contains a ROS package. */
export async function hasRosPackage(): Promise<boolean> {
  const manifests = await workspace.findFiles(MANIFEST_PATTERN, EXCLUDED_FOLDERS, MAX_MANIFESTS);
  for (const manifest of manifests) {
    if (isRosManifest(new TextDecoder().decode(await workspace.fs.readFile(manifest)))) return true;
  }
  return false;
}
