import type { Connection } from "../connection/connection";
import type { CatchUpFiles, Course, CourseProblem, CourseStep, CourseStepItem, StepChecks } from "../protocol";
import { Signal } from "../signal";

/** The course of the learner: its outline, the shown step, the results of its checks, and the page's requests. */
export class CourseState {
  /** The outline, the step, the results or the problem has changed. */
  readonly changed = new Signal();
  /** The program has begun or stopped showing a course. */
  readonly availabilityChanged = new Signal();
  /** Emitted with the absolute path of a file that the learner wants to edit. */
  readonly fileRequested = new Signal<string>();
  course: Course | null = null;
  step: CourseStep | null = null;
  checks: StepChecks | null = null;
  /** Emitted with the files of the course's state before the shown step, after `requestCatchUp`. */
  readonly catchUpAnswered = new Signal<CatchUpFiles>();
  /** Why the last request was not carried out. */
  problem: CourseProblem | null = null;
  /** Whether the connection is new, and the server has not sent a course yet. */
  private isCourseUnknown = true;
  /** Whether this page has asked for the files to catch up; all pages receive the answer. */
  private hasRequestedCatchUp = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => (this.isCourseUnknown = true));
    connection.on("course", (course) => {
      this.isCourseUnknown = false;
      const isNew = this.course === null;
      this.course = course;
      if (isNew) this.availabilityChanged.emit();
      this.changed.emit();
    });
    // The last message to a page that opens: a program without a course has sent no `course` before it.
    connection.on("frame_table", () => {
      if (this.isCourseUnknown && this.course !== null) {
        this.course = this.step = this.checks = this.problem = null;
        this.availabilityChanged.emit();
        this.changed.emit();
      }
      this.isCourseUnknown = false;
    });
    connection.on("course_step", (step) => {
      this.step = step;
      this.changed.emit();
    });
    connection.on("step_checks", (checks) => {
      this.checks = checks;
      this.changed.emit();
    });
    connection.on("catch_up_files", (files) => {
      const isRequested = this.hasRequestedCatchUp && files.address === this.step?.address;
      this.hasRequestedCatchUp = false;
      if (isRequested) this.catchUpAnswered.emit(files);
    });
    connection.on("course_problem", (problem) => {
      this.problem = problem.message === "" ? null : problem;
      this.changed.emit();
    });
  }

  get isAvailable(): boolean {
    return this.course !== null;
  }

  /** The steps of all lessons in order. */
  get steps(): readonly CourseStepItem[] {
    return this.course?.lessons.flatMap(({ steps }) => steps) ?? [];
  }

  /** The results of the shown step; null before they are known. */
  get results(): StepChecks | null {
    return this.checks?.address === this.step?.address ? this.checks : null;
  }

  /** Whether all checks of the shown step passed when they ran last. */
  get isPassed(): boolean {
    const { checks, checked_at: checkedAt } = this.results ?? { checks: [], checked_at: null };
    return checkedAt !== null && checks.every(({ is_passed: isPassed }) => isPassed);
  }

  /** The number of earlier steps whose files the failing checks of the shown step may need. */
  get missingCount(): number {
    const isFailing = !this.isPassed && (this.results?.checked_at ?? null) !== null;
    return isFailing ? (this.step?.missing_count ?? 0) : 0;
  }

  /** Returns the step that is `count` steps after the shown one, or undefined. */
  stepAt(count: number): CourseStepItem | undefined {
    const index = this.steps.findIndex(({ address }) => address === this.step?.address);
    return index < 0 ? undefined : this.steps[index + count];
  }

  open(address: string): void {
    this.connection.send({ type: "open_step", address });
  }

  /** Opens the step that is `count` steps after the shown one, if there is one. */
  moveBy(count: number): void {
    const step = this.stepAt(count);
    if (step) this.open(step.address);
  }

  check(): void {
    this.connection.send({ type: "check_step" });
  }

  answer(answer: string): void {
    this.connection.send({ type: "answer_step", answer });
  }

  takeHint(): void {
    this.connection.send({ type: "take_hint" });
  }

  /** Requests the files of the course's state before the shown step. */
  requestCatchUp(): void {
    this.hasRequestedCatchUp = true;
    this.connection.send({ type: "request_catch_up" });
  }

  /** Brings the workspace into the course's state before the shown step. */
  catchUp(): void {
    this.connection.send({ type: "catch_up" });
  }

  takeSolution(): void {
    this.connection.send({ type: "take_solution" });
  }
}
