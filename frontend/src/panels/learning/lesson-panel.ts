import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { CourseState } from "../../state/course";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";
import { formatShortcut, SHORTCUTS } from "../../widgets/shortcuts";
import { fileNameOf } from "../place";
import type { Panel } from "../panel";
import { createLessonText } from "./lesson-text";
import { localize } from "./local-text";
import { Outline } from "./outline";

/** The text of the shown step, its files, answer, hints and solution, and the controls to move to other steps. */
export class LessonPanel implements Panel {
  readonly id = "lesson";
  readonly icon = "lesson";
  readonly element: HTMLElement;
  private readonly empty = h("p", { class: "empty" }, strings.learning.off);
  private readonly lessonPlace = h("span", { class: "lesson-place" });
  private readonly textBox = h("div", { class: "lesson-body scroll", tabIndex: 0 });
  private readonly problem = h("div", { class: "lesson-problem", role: "alert" });
  private readonly answerField = h("input", { class: "field lesson-answer" });
  private readonly outline: Outline;
  private readonly outlineToggle: HTMLButtonElement;
  private readonly backButton: HTMLButtonElement;
  private readonly nextButton: HTMLButtonElement;
  private readonly hintButton: HTMLButtonElement;
  private readonly solutionButton: HTMLButtonElement;
  private readonly courseView: HTMLElement;
  /** Identifies the drawn text, so that a new result does not draw it again and scroll it. */
  private shownKey = "";
  private isOutlineShown = false;

  constructor(private readonly state: CourseState) {
    const texts = strings.learning;
    this.outline = new Outline(state, () => this.showOutline(false));
    this.outlineToggle = createButton(texts.outlineHint, () => this.showOutline(!this.isOutlineShown), "tool framed", createIcon("tree"), texts.outline);
    this.backButton = createButton(`${texts.backHint} (${formatShortcut(SHORTCUTS.previousStep)})`, () => state.moveBy(-1), "tool framed", texts.back);
    this.nextButton = createButton(`${texts.nextHint} (${formatShortcut(SHORTCUTS.nextStep)})`, () => state.moveBy(1), "tool framed", texts.next);
    this.hintButton = createButton(texts.hintHint, () => state.takeHint(), "tool framed", createIcon("bulb"), texts.hint);
    this.solutionButton = createButton(texts.solutionHint, () => this.askForSolution(), "tool framed", texts.solution);
    this.answerField.setAttribute("aria-label", texts.answer);
    this.answerField.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter" && !event.isComposing) this.sendAnswer();
    });
    this.courseView = h(
      "div",
      { class: "lesson" },
      h("header", { class: "lesson-head" }, this.outlineToggle, this.lessonPlace),
      this.outline.element,
      this.textBox,
      this.problem,
      h("footer", { class: "lesson-foot" }, this.backButton, this.hintButton, this.solutionButton, h("span", { class: "spacer" }), this.nextButton),
    );
    this.element = h("div", { class: "panel lesson-panel" }, this.empty, this.courseView);
    this.showOutline(false);
    state.changed.on(coalesce(() => this.update()));
    this.update();
  }

  /** Returns the state of the panel for tests. */
  inspect(): object {
    return { step: this.state.step?.address ?? "", checks: this.state.results, problem: this.state.problem };
  }

  private update(): void {
    const { state } = this;
    const { step } = state;
    this.empty.hidden = step !== null;
    this.courseView.hidden = step === null;
    if (step === null) return;
    const texts = strings.learning;
    const passedCount = state.steps.filter(({ is_passed: isPassed }) => isPassed).length;
    this.lessonPlace.replaceChildren(`${localize(step.lesson)} · `, h("span", {}, texts.progress(passedCount, state.steps.length)));
    this.backButton.disabled = state.stepAt(-1) === undefined;
    this.nextButton.disabled = state.stepAt(1) === undefined;
    this.nextButton.classList.toggle("primary", state.isPassed);
    this.hintButton.hidden = step.hint_count === 0;
    this.hintButton.disabled = step.hints.length >= step.hint_count;
    this.hintButton.lastChild?.replaceWith(texts.hintOf(step.hints.length, step.hint_count));
    this.solutionButton.hidden = !step.has_solution;
    this.problem.hidden = state.problem === null;
    this.problem.textContent = state.problem ? `${state.problem.message} ${state.problem.hint}`.trim() : "";
    if (this.isOutlineShown) this.outline.draw();
    this.drawText();
  }

  private drawText(): void {
    const { step } = this.state;
    if (step === null) return;
    const key = `${step.address} ${step.hints.length} ${step.right_answer ?? ""}`;
    if (key === this.shownKey) return;
    const isSameStep = this.shownKey.startsWith(`${step.address} `);
    this.shownKey = key;
    const hints = step.hints.map((hint) => createLessonText(localize(hint), "lesson-text lesson-hint"));
    const rightAnswer = step.right_answer === null ? [] : [h("p", { class: "lesson-text lesson-hint" }, strings.learning.rightAnswer(appendUnit(step.right_answer, step.unit)))];
    this.textBox.replaceChildren(
      h("h2", {}, localize(step.title)),
      ...(localize(step.introduction) === "" ? [] : [createLessonText(localize(step.introduction), "lesson-text lesson-introduction")]),
      createLessonText(localize(step.body), "lesson-text"),
      ...this.createFileRow(step.files),
      ...this.createAnswerRow(step.unit, step.answer),
      ...hints,
      ...rightAnswer,
    );
    if (isSameStep) [...hints, ...rightAnswer].at(-1)?.scrollIntoView({ block: "nearest" });
    else this.textBox.scrollTop = 0;
  }

  private createFileRow(files: readonly string[]): HTMLElement[] {
    if (files.length === 0) return [];
    const texts = strings.learning;
    const buttons = files.map((path) => createButton(texts.openFile(path), () => this.state.fileRequested.emit(path), "tool framed", createIcon("file"), fileNameOf(path)));
    return [h("div", { class: "lesson-row" }, h("span", { class: "toolbar-label" }, texts.files), ...buttons)];
  }

  private createAnswerRow(unit: string | null, answer: string | null): HTMLElement[] {
    if (unit === null) return [];
    const texts = strings.learning;
    this.answerField.value = answer ?? "";
    const sendButton = createButton(texts.answerHint, () => this.sendAnswer(), "tool framed primary", texts.sendAnswer);
    return [h("div", { class: "lesson-row" }, h("span", { class: "toolbar-label" }, texts.answer), this.answerField, unit === "1" ? null : h("span", {}, unit), sendButton)];
  }

  private sendAnswer(): void {
    if (this.answerField.value.trim() !== "") this.state.answer(this.answerField.value);
  }

  private showOutline(isShown: boolean): void {
    this.isOutlineShown = isShown;
    this.outline.element.hidden = !isShown;
    this.textBox.hidden = isShown;
    this.outlineToggle.setAttribute("aria-expanded", String(isShown));
    if (isShown) this.outline.draw();
  }

  private askForSolution(): void {
    const texts = strings.learning;
    const folder = this.state.course?.folder ?? "";
    const files = (this.state.step?.solution ?? []).map((path) => path.slice(folder.length + 1));
    const copiedFiles = [h("p", {}, texts.solutionText), h("ul", {}, ...files.map((path) => h("li", {}, path)))];
    const answerNote = (this.state.step?.unit ?? null) === null ? [] : [h("p", {}, texts.solutionNumber)];
    new Dialog(texts.solutionTitle, [...(files.length > 0 ? copiedFiles : []), ...answerNote], [
      { label: strings.shell.cancel },
      { label: texts.solutionTake, run: () => (this.state.takeSolution(), undefined), isPrimary: true },
    ]).open();
  }
}

function appendUnit(number: string, unit: string | null): string {
  return unit === null || unit === "1" ? number : `${number} ${unit}`;
}
