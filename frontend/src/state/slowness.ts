import type { Connection } from "../connection/connection";
import { Signal } from "../signal";
import type { DrawingPace } from "./drawing-pace";
import type { SlowConnection } from "./slow-connection";

/** The cause of a reduced data rate: the drawing of the page, the program, or the connection between them. */
export type SlowCause = "page" | "program" | "line";

/** The interval at which the delay of the page's timers is measured, ms. */
const MEASUREMENT_INTERVAL_MS = 50;
/** The number of measurements that are averaged. */
const AVERAGED_MEASUREMENT_COUNT = 40;
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
    private readonly slowConnection: Pick<SlowConnection, "changed" | "reducedDisplays">,
    private readonly drawingPace: Pick<DrawingPace, "isSlow">,
    connection: Connection,
    private readonly now: () => number = () => performance.now(),
  ) {
    slowConnection.changed.on(() => this.updateTimer());
    connection.on("program_is_late", ({ late }) => {
      this.isProgramLate = late;
      this.changed.emit();
    });
    connection.on("hello", () => (this.isProgramLate = false));
  }

  get cause(): SlowCause {
    if (this.drawingPace.isSlow || this.isPageLate) return "page";
    return this.isProgramLate ? "program" : "line";
  }

  private updateTimer(): void {
    const isNeeded = this.slowConnection.reducedDisplays.length > 0;
    if (isNeeded === (this.timer !== undefined)) return;
    clearTimeout(this.timer);
    this.timer = undefined;
    if (isNeeded) this.scheduleMeasurement();
  }

  /** Schedules a measurement: messages wait for a busy page as long as its timers do. */
  private scheduleMeasurement(): void {
    const dueTime = this.now() + MEASUREMENT_INTERVAL_MS;
    this.timer = setTimeout(() => {
      // Browsers delay the timers of hidden pages.
      if (!globalThis.document.hidden) this.addMeasurement(Math.max(0, this.now() - dueTime));
      this.scheduleMeasurement();
    }, MEASUREMENT_INTERVAL_MS);
  }

  private addMeasurement(delay: number): void {
    this.delays.push(delay);
    if (this.delays.length > AVERAGED_MEASUREMENT_COUNT) this.delays.shift();
    const sum = this.delays.reduce((total, delay) => total + delay, 0);
    const share = sum / (sum + this.delays.length * MEASUREMENT_INTERVAL_MS);
    const isLate = this.isPageLate ? share > TIMELY_SHARE : share >= LATE_SHARE;
    if (isLate === this.isPageLate) return;
    this.isPageLate = isLate;
    this.changed.emit();
  }
}
