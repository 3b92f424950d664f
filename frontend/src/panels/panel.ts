import type { IconName } from "../icons";

export type PanelId = "displays" | "scene" | "views" | "joints" | "diagnostics";

/** What stands in a dock: made once, shown, hidden and moved by the user. */
export interface Panel {
  readonly id: PanelId;
  readonly icon: IconName;
  readonly element: HTMLElement;
}
