import { h } from "../../dom";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import type { PlanningDeck } from "./planning-deck";

/** MoveIt's MotionPlanning panel, whose code is loaded when the panel is first shown with a display that can plan. */
export class MotionPlanningPanel implements Panel {
  readonly id = "motion-planning";
  readonly icon = "MotionPlanning";
  readonly element: HTMLElement;
  private readonly notice = h("p", { class: "empty" }, strings.motionPlanning.off);
  private deck: PlanningDeck | null = null;
  private isVisible = false;
  private isLoading = false;

  constructor(private readonly session: Session) {
    this.element = h("div", { class: "panel monitor planning-panel" }, this.notice);
    onVisibilityChange(this.element, (isVisible) => {
      this.isVisible = isVisible;
      this.update();
    });
    session.motionPlanning.changed.on(() => this.update());
  }

  private update(): void {
    const state = this.session.motionPlanning.current;
    this.notice.hidden = state !== null && this.deck !== null;
    this.notice.textContent = state ? strings.motionPlanning.loading : strings.motionPlanning.off;
    if (this.deck) {
      this.deck.element.hidden = state === null;
      if (state && this.isVisible) this.deck.show(state);
    } else if (state && this.isVisible && !this.isLoading) void this.load();
  }

  private async load(): Promise<void> {
    this.isLoading = true;
    try {
      const { PlanningDeck } = await import("./planning-deck");
      this.deck = new PlanningDeck(this.session);
      this.element.append(this.deck.element);
      this.update();
    } catch {
      this.notice.textContent = strings.motionPlanning.failed;
    }
    this.isLoading = false;
  }
}
