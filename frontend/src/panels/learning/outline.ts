import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { CourseStepItem } from "../../protocol";
import type { CourseState } from "../../state/course";
import { strings } from "../../strings";
import { localize } from "./local-text";

/** The lessons and steps of the course, with the learner's progress. */
export class Outline {
  readonly element = h("nav", { class: "course-outline", aria: { label: strings.learning.outline } });

  /** @param onStepOpened - called when the learner has opened a step. */
  constructor(
    private readonly state: CourseState,
    private readonly onStepOpened: () => void,
  ) {}

  draw(): void {
    const lessons = this.state.course?.lessons ?? [];
    this.element.replaceChildren(
      ...lessons.map(({ title, steps }, index) =>
        h(
          "section",
          {},
          h("h3", {}, `${index + 1}. ${localize(title)}`),
          ...steps.map((step) => this.createRow(step, localize(step.title))),
        ),
      ),
    );
  }

  private createRow({ address, is_passed: isPassed, is_taken_over: isTakenOver }: CourseStepItem, name: string): HTMLElement {
    const open = (): void => {
      this.state.open(address);
      this.onStepOpened();
    };
    const texts = strings.learning;
    const statusIcon = isPassed ? createIcon("check", "level-ok") : isTakenOver ? createIcon("download") : h("span", { class: "outline-mark" });
    const title = isPassed ? texts.passedStep(name) : isTakenOver ? texts.takenOverStep(name) : name;
    const row = createButton(title, open, "outline-step", statusIcon, name);
    if (address === this.state.step?.address) row.setAttribute("aria-current", "step");
    return row;
  }
}
