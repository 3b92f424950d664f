import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { StepCheck } from "../../protocol";
import type { CourseState } from "../../state/course";
import { languageTag, strings } from "../../strings";
import { formatShortcut, SHORTCUTS } from "../../widgets/shortcuts";
import type { Panel } from "../panel";
import { askToCatchUp } from "./catch-up";
import { localize } from "./local-text";

/** The results of the checks of the shown step. */
export class ChecksPanel implements Panel {
  readonly id = "checks";
  readonly icon = "check";
  readonly element: HTMLElement;
  private readonly empty = h("p", { class: "empty" }, strings.learning.off);
  private readonly status = h("span", { class: "checks-status", role: "status" });
  private readonly list = h("ul", { class: "checks-list" });
  private readonly offerText = h("span");
  private readonly catchUpOffer: HTMLElement;
  private readonly nextButton: HTMLButtonElement;
  private readonly content: HTMLElement;

  constructor(private readonly state: CourseState) {
    const texts = strings.learning;
    const checkButton = createButton(`${texts.checkHint} (${formatShortcut(SHORTCUTS.checkStep)})`, () => state.check(), "tool framed", texts.check);
    this.nextButton = createButton(`${texts.nextHint} (${formatShortcut(SHORTCUTS.nextStep)})`, () => state.moveBy(1), "tool framed primary", texts.nextStep);
    this.catchUpOffer = h("div", { class: "checks-offer" }, this.offerText, createButton(texts.catchUpHint, () => state.requestCatchUp(), "tool framed", texts.catchUp));
    this.content = h(
      "div",
      { class: "checks" },
      h("header", { class: "checks-head" }, this.status, h("span", { class: "spacer" }), checkButton, this.nextButton),
      this.catchUpOffer,
      h("div", { class: "scroll", role: "group", tabIndex: 0, aria: { label: texts.checks } }, this.list),
    );
    this.element = h("div", { class: "panel checks-panel" }, this.empty, this.content);
    state.catchUpAnswered.on((files) => askToCatchUp(state, files));
    state.changed.on(coalesce(() => this.update()));
    this.update();
  }

  private update(): void {
    const { state } = this;
    const { results } = state;
    this.empty.hidden = state.isAvailable;
    this.content.hidden = !state.isAvailable;
    this.status.textContent = this.formatStatus();
    this.element.classList.toggle("running", results?.is_running === true);
    this.element.classList.toggle("passed", state.isPassed);
    this.catchUpOffer.hidden = state.missingCount === 0;
    this.offerText.textContent = strings.learning.missingSteps(state.missingCount);
    this.nextButton.hidden = !state.isPassed || state.stepAt(1) === undefined;
    this.list.replaceChildren(...(results?.checks ?? []).map((check) => createRow(check)));
  }

  private formatStatus(): string {
    const texts = strings.learning;
    const { results } = this.state;
    if (results === null || results.is_running) return results?.is_world_paused === true ? texts.checkingAlone : texts.checking;
    if (results.checked_at === null) return "";
    const time = new Date(results.checked_at * 1000).toLocaleTimeString(languageTag);
    const passedCount = results.checks.filter(({ is_passed: isPassed }) => isPassed).length;
    return this.state.isPassed ? texts.allPassed(time) : texts.somePassed(passedCount, results.checks.length, time);
  }
}

function createRow({ title, is_passed: isPassed, message }: StepCheck): HTMLElement {
  const statusIcon = isPassed ? createIcon("check", "level-ok") : createIcon("close", "level-error");
  const stateText = h("span", { class: "hidden-text" }, isPassed ? strings.learning.passed : strings.learning.missing);
  const text = message === null ? null : h("p", { class: "check-message" }, localize(message));
  return h("li", { class: "step-check" }, statusIcon, h("div", {}, stateText, localize(title), text));
}
