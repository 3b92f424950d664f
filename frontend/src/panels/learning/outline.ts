import { button, h } from "../../dom";
import { icon } from "../../icons";
import type { CourseState } from "../../state/course";
import { strings } from "../../strings";
import { localText } from "./local-text";

/** The lessons and steps of the course, with the learner's progress. */
export class Outline {
  readonly element = h("nav", { class: "course-outline", aria: { label: strings.learning.outline } });

  /**
   * @param onChosen - called when the learner has opened a step.
   */
  constructor(
    private readonly state: CourseState,
    private readonly onChosen: () => void,
  ) {}

  draw(): void {
    const lessons = this.state.course?.lessons ?? [];
    this.element.replaceChildren(
      ...lessons.map(({ title, steps }, index) =>
        h(
          "section",
          {},
          h("h3", {}, `${index + 1}. ${localText(title)}`),
          ...steps.map(({ address, title: name, is_passed: isPassed }) => this.row(address, localText(name), isPassed)),
        ),
      ),
    );
  }

  private row(address: string, name: string, isPassed: boolean): HTMLElement {
    const open = (): void => {
      this.state.open(address);
      this.onChosen();
    };
    const mark = isPassed ? icon("check", "level-ok") : h("span", { class: "outline-mark" });
    const row = button(isPassed ? strings.learning.passedStep(name) : name, open, "outline-step", mark, name);
    if (address === this.state.step?.address) row.setAttribute("aria-current", "step");
    return row;
  }
}
