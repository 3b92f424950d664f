import { workspace } from "vscode";
import { isRosManifest, MANIFESTS } from "../server/documents.js";

const NOT_SEARCHED = "**/{node_modules,build,install,log,.venv,venv}/**";
const MOST_MANIFESTS = 20;

/** Return whether a folder of the workspace contains a ROS package. */
export async function hasRosPackage(): Promise<boolean> {
  const manifests = await workspace.findFiles(MANIFESTS, NOT_SEARCHED, MOST_MANIFESTS);
  for (const manifest of manifests) {
    if (isRosManifest(new TextDecoder().decode(await workspace.fs.readFile(manifest)))) return true;
  }
  return false;
}
