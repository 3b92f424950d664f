import { h } from "../../dom";

/** The scene below the cards. */
export interface CoveredScene {
  /** Returns the width covered at the right, pixels. */
  getCoveredWidth: () => number;
  /** The rightmost pixel column that robots cover, from the left edge. */
  readonly robotsRightEdge: number;
  /** Shifts the view left, so that the focal point is in the center of the part beside the cards. */
  avoidCards(): void;
  /** Shifts the view down so that a notice of this height (pixels) at the upper edge does not cover the robots. */
  avoidNotices(height: number): void;
}

/** The cards over the right side of the scene, one below the other, which share its height. */
export class CardColumn {
  readonly element = h("div", { class: "stack" });
  private scene: CoveredScene | null = null;

  connectScene(scene: CoveredScene): void {
    this.scene = scene;
    scene.getCoveredWidth = () => this.coveredWidth;
  }

  /** Whether a card that opens would cover a robot. */
  get isOverRobots(): boolean {
    return this.scene !== null && this.scene.robotsRightEdge > this.left;
  }

  /** Updates the scene after the user opened or closed a card. */
  readonly onCardToggled = (): void => this.scene?.avoidCards();

  private get coveredWidth(): number {
    const cards = [...this.element.querySelectorAll<HTMLElement>(".inspect-card, .selection-card:not(.folded)")];
    const isOpen = cards.some((card) => card.offsetHeight > 0);
    return isOpen ? (this.element.parentElement?.clientWidth ?? 0) - this.left : 0;
  }

  /** The distance of the column from the scene's left edge, pixels. */
  private get left(): number {
    return this.element.getBoundingClientRect().left - (this.element.parentElement?.getBoundingClientRect().left ?? 0);
  }
}
