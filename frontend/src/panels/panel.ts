import type { IconName } from "../icons";

export type PanelId = "plot" | "topics" | "graph" | "parameters" | "log" | "services" | "publishers" | "controllers" | "trajectories" | "teleop" | "displays" | "scene" | "joint-table" | "source" | "diagram" | "links" | "views" | "tool-properties" | "selection" | "time" | "transformation" | "help" | "visual-tools" | "navigation" | "joints" | "voice" | "diagnostics" | "world" | "comparison" | "editing" | "terminal" | "program" | "lesson" | "checks" | "motion-planning" | "turtlesim";

/** A panel of the dock, created once; the user shows, hides and moves it. */
export interface Panel {
  readonly id: PanelId;
  readonly icon: IconName;
  readonly element: HTMLElement;
  /** Called when the user opened the panel; another panel may be in front of it. */
  onOpened?(): void;
  /** Called when the user closed the panel. */
  onClosed?(): void;
}
