import { Signal } from "../signal";

/** The number of recent frames that are judged. */
const JUDGED_FRAME_COUNT = 60;
/** Drawing is slow from this number of late frames on, and fast again from this number down. */
const SLOW_LATE_FRAME_COUNT = 45;
const FAST_LATE_FRAME_COUNT = 15;

/** Whether the page draws as fast as requested. Only frames that were due count; a low frame rate alone is not slow. */
export class DrawingPace {
  /** Drawing became slow, or fast again. */
  readonly changed = new Signal();
  /** The name of the software renderer; null if a GPU draws. */
  softwareRenderer: string | null = null;
  private readonly recentLateness: boolean[] = [];
  private wasSlow = false;

  get isSlow(): boolean {
    return this.wasSlow;
  }

  /** Counts a frame; `isLate` if it was drawn long after it was due, because the frames before took too long. */
  countFrame(isLate: boolean): void {
    this.recentLateness.push(isLate);
    if (this.recentLateness.length > JUDGED_FRAME_COUNT) this.recentLateness.shift();
    const lateCount = this.recentLateness.filter(Boolean).length;
    const isSlow = this.wasSlow ? lateCount > FAST_LATE_FRAME_COUNT : lateCount >= SLOW_LATE_FRAME_COUNT;
    if (isSlow === this.wasSlow) return;
    this.wasSlow = isSlow;
    this.changed.emit();
  }
}
