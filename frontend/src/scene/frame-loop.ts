import { Signal } from "../state/signal";

/** Frames may come this much early and still count as keeping to the rate: screens do not tick evenly. */
const TOLERANCE_MS = 4;
/** With nothing drawn for this long the scene counts as idle. */
const IDLE_AFTER_MS = 600;

/** Draws on demand: nothing while nothing changes, never more often than the rate. */
export class FrameLoop {
  /** A frame was drawn. */
  readonly drawn = new Signal();
  private requested = false;
  private lastMs = -Infinity;
  private recent: number[] = [];
  private count = 0;
  /** Largest number of frames a second. */
  rate = 30;

  constructor(private readonly draw: () => void) {}

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
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame(this.tick);
  }

  private readonly tick = (nowMs: number): void => {
    if (nowMs - this.lastMs < 1000 / Math.max(1, this.rate) - TOLERANCE_MS) {
      requestAnimationFrame(this.tick);
      return;
    }
    this.requested = false;
    this.lastMs = nowMs;
    this.recent.push(nowMs);
    this.draw();
    this.count += 1;
    this.drawn.emit();
  };
}
