import type { Connection } from "../connection/connection";
import { Signal } from "../signal";
import type { DrawingPace } from "./drawing-pace";
import type { SlowConnection } from "./slow-connection";

/** The cause of a reduced data rate: the drawing of the page, the program, or the connection between them. */
export type SlowCause = "page" | "program" | "line";

/** The interval at which the delay of the page's timers is measured, ms. */
const INTERVAL_MS = 50;
/** The number of measurements that are averaged. */
const AVERAGED_COUNT = 40;
/** The page counts as late from the first share of time on, until it falls below the second. */
const LATE_SHARE = 0.3;
const TIMELY_SHARE = 0.15;

/** Finds the cause while the page's data rate is reduced. */
export class Slowness {
  readonly changed = new Signal();
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly delays: number[] = [];
  private isPageLate = false;
  private isProgramLate = false;

  constructor(
    private readonly slowConnection: Pick<SlowConnection, "changed" | "reduced">,
    private readonly pace: Pick<DrawingPace, "isSlow">,
    connection: Connection,
    private readonly now: () => number = () => performance.now(),
  ) {
    slowConnection.changed.on(() => this.startOrStop());
    connection.on("program_is_late", ({ late }) => {
      this.isProgramLate = late;
      this.changed.emit();
    });
    connection.on("hello", () => (this.isProgramLate = false));
  }

  get cause(): SlowCause {
    if (this.pace.isSlow || this.isPageLate) return "page";
    return this.isProgramLate ? "program" : "line";
  }

  private startOrStop(): void {
    const isNeeded = this.slowConnection.reduced.length > 0;
    if (isNeeded === (this.timer !== undefined)) return;
    clearTimeout(this.timer);
    this.timer = undefined;
    if (isNeeded) this.scheduleMeasurement();
  }

  /** Schedules a measurement: messages wait for a busy page as long as its timers do. */
  private scheduleMeasurement(): void {
    const due = this.now() + INTERVAL_MS;
    this.timer = setTimeout(() => {
      // Browsers delay the timers of hidden pages.
      if (!globalThis.document.hidden) this.addMeasurement(Math.max(0, this.now() - due));
      this.scheduleMeasurement();
    }, INTERVAL_MS);
  }

  private addMeasurement(delay: number): void {
    this.delays.push(delay);
    if (this.delays.length > AVERAGED_COUNT) this.delays.shift();
    const sum = this.delays.reduce((total, delay) => total + delay, 0);
    const share = sum / (sum + this.delays.length * INTERVAL_MS);
    const isLate = this.isPageLate ? share > TIMELY_SHARE : share >= LATE_SHARE;
    if (isLate === this.isPageLate) return;
    this.isPageLate = isLate;
    this.changed.emit();
  }
}
