import { h } from "../../dom";

/** The scene, as the cards over it see it. */
export interface Below {
  /** The width in pixels that is covered at the right. */
  covered: () => number;
  /** The distance from the left edge that robots reach, pixels. */
  readonly robotsReach: number;
  /** Moves the focal point to the middle of the uncovered part. */
  makeRoom(): void;
  /** Moves the visible content below an element of this height, pixels, that covers the upper edge. */
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

  /** Whether a card that opens would cover a robot. */
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

  /** The distance of the column from the scene's left edge, pixels. */
  private get left(): number {
    return this.element.getBoundingClientRect().left - (this.element.parentElement?.getBoundingClientRect().left ?? 0);
  }
}
