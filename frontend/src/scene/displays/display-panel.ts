import type { IconName } from "../../icons";

/** A display's own panel, which exists while the display is enabled. */
export interface DisplayPanel {
  /** `display:` followed by the display's ID. */
  readonly key: string;
  readonly title: string;
  readonly icon: IconName;
  readonly element: HTMLElement;
  /** Whether the panel replaces the scene, because a recording with images only has nothing to show in it. */
  readonly replacesScene: boolean;
  /** Called when the user closes the panel. */
  onClosed(): void;
}

/** The host of the panels of displays. */
export interface PanelHost {
  offer(panel: DisplayPanel): void;
  withdraw(key: string): void;
  retitle(key: string, title: string): void;
}
