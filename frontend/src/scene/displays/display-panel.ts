import type { IconName } from "../../icons";

/** A panel of a display: it comes and goes with the display. */
export interface DisplayPanel {
  /** `display:` and the display's id. */
  readonly key: string;
  readonly title: string;
  readonly icon: IconName;
  readonly element: HTMLElement;
  /** Whether it is in place of the scene, in which nothing is to be seen: of a recording with images and nothing else. */
  readonly instead: boolean;
  /** The user closes it. */
  closed(): void;
}

/** The host of displays' own panels. */
export interface PanelHost {
  offer(panel: DisplayPanel): void;
  withdraw(key: string): void;
  retitle(key: string, title: string): void;
}
