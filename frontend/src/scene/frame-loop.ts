import { Signal } from "../state/signal";

/** Frames may come this much early and still count as keeping to the rate: screens do not tick evenly. */
const TOLERANCE_MS = 4;
/** With nothing drawn for this long the scene counts as idle. */
const IDLE_AFTER_MS = 600;
/** A frame that comes this long after it was due was held up by the ones before it. */
const LATE_MS = 30;
/** So many more late frames than timely ones make moving pictures coarse. */
const LATE_FRAMES = 4;
/** After a coarse frame, how long nothing must move until a fine one is drawn. */
const STILL_AFTER_MS = 250;

/**
 * Draws on demand: nothing while nothing changes, never more often than the rate. Where the machine does not keep up,
 * as software renderers, moving frames are drawn coarsely and a fine one follows when the scene stands still.
 */
export class FrameLoop {
  /** A frame was drawn. */
  readonly drawn = new Signal();
  /** Largest number of frames a second. */
  rate = 30;
  private requestedAt: number | null = null;
  private lastMs = -Infinity;
  private lateness = 0;
  private coarse = false;
  private lastIsFine = false;
  private stillTimer = 0;
  private recent: number[] = [];
  private count = 0;

  constructor(private readonly draw: (fine: boolean) => void) {}

  /** Nothing changed since the last frame, and that was a fine one. */
  get settled(): boolean {
    return this.requestedAt === null && this.lastIsFine;
  }

  get framesDrawn(): number {
    return this.count;
  }

  /** Frames drawn in the last second, or null when the scene is idle. */
  framesPerSecond(nowMs: number): number | null {
    this.recent = this.recent.filter((at) => nowMs - at < 1000);
    return nowMs - this.lastMs > IDLE_AFTER_MS ? null : this.recent.length;
  }

  /** Something changed: a frame is due. */
  invalidate(): void {
    if (this.requestedAt !== null) return;
    this.requestedAt = performance.now();
    requestAnimationFrame(this.tick);
  }

  private readonly tick = (): void => {
    const now = performance.now();
    const interval = 1000 / Math.max(1, this.rate);
    if (now - this.lastMs < interval - TOLERANCE_MS) {
      requestAnimationFrame(this.tick);
      return;
    }
    this.judge(now - Math.max(this.requestedAt ?? now, this.lastMs + interval));
    this.requestedAt = null;
    // The first frame must come soon.
    const fine = !this.coarse && this.count > 0;
    this.paint(now, fine);
    clearTimeout(this.stillTimer);
    if (!fine) this.stillTimer = window.setTimeout(() => this.stand(), STILL_AFTER_MS);
  };

  private judge(delay: number): void {
    this.lateness = Math.max(0, this.lateness + (delay > LATE_MS ? 1 : -1));
    if (this.lateness >= LATE_FRAMES) this.coarse = true;
  }

  private stand(): void {
    if (this.requestedAt === null) this.paint(performance.now(), true);
  }

  private paint(now: number, fine: boolean): void {
    this.lastMs = now;
    this.recent.push(now);
    this.draw(fine);
    this.lastIsFine = fine;
    this.count += 1;
    this.drawn.emit();
  }
}
