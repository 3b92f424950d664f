import type { IconName } from "../../icons";

/** A panel of a display: it comes and goes with the display. */
export interface DisplayPanel {
  /** `display:` and the display's id. */
  readonly key: string;
  readonly title: string;
  readonly icon: IconName;
  readonly element: HTMLElement;
  /** The user closes it. */
  closed(): void;
}

/** Where displays put panels of their own. */
export interface PanelHost {
  offer(panel: DisplayPanel): void;
  withdraw(key: string): void;
  retitle(key: string, title: string): void;
}
