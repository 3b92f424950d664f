import { h } from "../../dom";

/** What a scene knows and does for what lies over it. */
export interface Below {
  /** How many pixels at the right something lies over. */
  covered: () => number;
  /** How far from its left edge robots reach, pixels. */
  readonly robotsReach: number;
  /** What is looked at goes to the middle of what nothing lies over. */
  makeRoom(): void;
  /** What stands as high as something that lies over the upper edge, pixels, goes below it. */
  makeRoomAbove(height: number): void;
}

/** The cards over the scene at its right, one below the other: they share the height that there is. */
export class CardColumn {
  readonly element = h("div", { class: "stack" });
  private below: Below | null = null;

  lieOver(below: Below): void {
    this.below = below;
    below.covered = () => this.covered;
  }

  /** Whether a card that opens would lie over a robot. */
  get isOverRobots(): boolean {
    return this.below !== null && this.below.robotsReach > this.left;
  }

  /** A card was opened or closed by the user. */
  readonly changed = (): void => this.below?.makeRoom();

  private get covered(): number {
    const cards = [...this.element.querySelectorAll<HTMLElement>(".inspect-card, .selection-card:not(.folded)")];
    const isOpen = cards.some((each) => each.offsetHeight > 0);
    return isOpen ? (this.element.parentElement?.clientWidth ?? 0) - this.left : 0;
  }

  /** Where it begins, in pixels from the scene's left edge. */
  private get left(): number {
    return this.element.getBoundingClientRect().left - (this.element.parentElement?.getBoundingClientRect().left ?? 0);
  }
}
