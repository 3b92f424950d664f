import { workspace } from "vscode";

export const INTERPRETER = "linkwright.interpreter";

/** Return the setting `linkwright.interpreter`. */
export function interpreter(): string {
  return workspace.getConfiguration().get(INTERPRETER, "");
}

/** Return the setting `linkwright.package`. */
export function packageSource(): string {
  return workspace.getConfiguration().get("linkwright.package", "");
}
