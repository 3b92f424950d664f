import type { IconName } from "../icons";

export type PanelId = "plot" | "topics" | "graph" | "parameters" | "log" | "teleop" | "displays" | "scene" | "joint-table" | "source" | "diagram" | "links" | "views" | "tool-properties" | "selection" | "time" | "transformation" | "navigation" | "joints" | "voice" | "diagnostics" | "world" | "comparison" | "editing";

/** A panel of the dock: made once, shown, hidden and moved by the user. */
export interface Panel {
  readonly id: PanelId;
  readonly icon: IconName;
  readonly element: HTMLElement;
  /** The user opened it; it may be behind another. */
  opened?(): void;
  /** The user closed it. */
  closed?(): void;
}
