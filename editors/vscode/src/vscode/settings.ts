import { workspace } from "vscode";

export const INTERPRETER = "linkwright.interpreter";

/** Return the setting `linkwright.interpreter`. */
export function readInterpreter(): string {
  return workspace.getConfiguration().get(INTERPRETER, "");
}

/** Return the setting `linkwright.package`. */
export function readPackageSource(): string {
  return workspace.getConfiguration().get("linkwright.package", "");
}
