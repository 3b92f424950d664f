import type { Connection } from "../connection/connection";
import { Signal } from "../signal";
import type { DrawingPace } from "./drawing-pace";
import type { SlowLine } from "./slow-line";

/** The cause of a reduced data rate: the drawing of the page, the program, or the connection between them. */
export type SlowCause = "page" | "program" | "line";

/** The interval at which the page's lateness is measured, ms. */
const EVERY_MS = 50;
/** The number of measurements that are averaged. */
const LOOKS = 40;
/** The page counts as late from the first share of time on, until it falls below the second. */
const LATE = 0.3;
const TIMELY = 0.15;

/** Finds the cause while the page's data rate is reduced. */
export class Slowness {
  readonly changed = new Signal();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly lates: number[] = [];
  private pageIsLate = false;
  private programIsLate = false;

  constructor(
    private readonly slowLine: Pick<SlowLine, "changed" | "reduced">,
    private readonly pace: Pick<DrawingPace, "isSlow">,
    connection: Connection,
    private readonly now: () => number = () => performance.now(),
  ) {
    slowLine.changed.on(() => this.follow());
    connection.on("program_is_late", ({ late }) => {
      this.programIsLate = late;
      this.changed.emit();
    });
    connection.on("hello", () => (this.programIsLate = false));
  }

  get cause(): SlowCause {
    if (this.pace.isSlow || this.pageIsLate) return "page";
    return this.programIsLate ? "program" : "line";
  }

  private follow(): void {
    const wanted = this.slowLine.reduced.length > 0;
    if (wanted === (this.timer !== undefined)) return;
    clearTimeout(this.timer);
    this.timer = undefined;
    if (wanted) this.lookLater();
  }

  /** Schedules a measurement: messages wait for a busy page as long as its timers do. */
  private lookLater(): void {
    const due = this.now() + EVERY_MS;
    this.timer = setTimeout(() => {
      // Browsers delay the timers of hidden pages.
      if (!globalThis.document.hidden) this.take(Math.max(0, this.now() - due));
      this.lookLater();
    }, EVERY_MS);
  }

  private take(late: number): void {
    this.lates.push(late);
    if (this.lates.length > LOOKS) this.lates.shift();
    const sum = this.lates.reduce((all, each) => all + each, 0);
    const share = sum / (sum + this.lates.length * EVERY_MS);
    const isLate = this.pageIsLate ? share > TIMELY : share >= LATE;
    if (isLate === this.pageIsLate) return;
    this.pageIsLate = isLate;
    this.changed.emit();
  }
}
