import { Signal } from "../signal";

/** Frames may be this much early and still count as in time, because screens do not refresh evenly. */
const TOLERANCE_MS = 4;
/** The scene counts as idle after this time without a frame. */
const IDLE_AFTER_MS = 600;
/** A frame this late was delayed by the frames before it: most of a refresh interval of the screen. */
const LATE_MS = 12;
/** This many more late frames than timely ones make moving frames coarser. */
const LATE_FRAME_COUNT = 4;
/** The first frames are not judged: they wait for shaders to compile. */
const FIRST_FRAME_COUNT = 6;
/** This many timely frames in a row make moving frames finer again; the number doubles each time. */
const TIMELY_FRAME_COUNT = 300;
/** After a coarse frame, a fine one is drawn once nothing has changed for this time. */
const STILL_AFTER_MS = 250;

/**
 * The detail of a frame: whether it is antialiased, and its resolution as a share of the canvas's pixels along each
 * side.
 */
export interface Detail {
  /** Whether the frame is part of a motion that the machine draws slowly, so that details may be omitted. */
  readonly isMoving: boolean;
  readonly isAntialiased: boolean;
  readonly resolutionShare: number;
}

export const FINEST_DETAIL: Detail = { isMoving: false, isAntialiased: true, resolutionShare: 1 };
const DETAILS: readonly Detail[] = [
  FINEST_DETAIL,
  { isMoving: true, isAntialiased: false, resolutionShare: 1 },
  { isMoving: true, isAntialiased: false, resolutionShare: 0.7 },
  { isMoving: true, isAntialiased: false, resolutionShare: 0.5 },
];

/**
 * Draws frames on demand: none while nothing changes, and never more than `rate`. On machines that are too slow, such
 * as those with software renderers, moving frames become coarser step by step, and a fine frame follows when the scene
 * is still.
 *
 * Content outside the scene with a rate of its own, such as camera images, is updated in step with frames: browsers
 * compose the whole page for each change, which without a GPU costs as much as the scene.
 */
export class FrameLoop {
  /** A frame was drawn. */
  readonly drawn = new Signal();
  /** A due frame was judged; true if the frames before it made it late. */
  readonly judged = new Signal<boolean>();
  /** Maximum number of frames per second. */
  rate = 30;
  private requestedMs: number | null = null;
  private readonly scheduledUpdates = new Set<() => void>();
  private isTickRequested = false;
  /** The earliest time of the next frame. */
  private dueMs = -Infinity;
  private lateScore = 0;
  private timelyCount = 0;
  private requiredTimelyCount = TIMELY_FRAME_COUNT;
  /** The index in `DETAILS` for moving frames. */
  private detailLevel = 0;
  private wasLastFrameFine = false;
  private stillTimer = 0;
  private lastDrawnMs = -Infinity;
  private recentTimes: number[] = [];
  private frameCount = 0;

  /**
   * @param isHeld - whether to draw nothing before `release`. For a software renderer, a frame of an empty scene is as
   * much work as one of a robot, and would delay it.
   */
  constructor(
    private readonly draw: (detail: Detail) => void,
    private isHeld = false,
  ) {}

  /** Whether nothing has changed since the last frame, in the scene or outside it, and that frame was a fine one. */
  get isSettled(): boolean {
    return this.requestedMs === null && this.scheduledUpdates.size === 0 && this.wasLastFrameFine;
  }

  /** Draws moving frames coarsely from the first one on, because the renderer is known to be slow. */
  expectSlow(): void {
    this.detailLevel = Math.max(this.detailLevel, 1);
  }

  get framesDrawn(): number {
    return this.frameCount;
  }

  /** Returns the number of frames in the last second; null while the scene is idle. */
  computeFrameRate(nowMs: number): number | null {
    this.recentTimes = this.recentTimes.filter((timeMs) => nowMs - timeMs < 1000);
    return nowMs - this.lastDrawnMs > IDLE_AFTER_MS ? null : this.recentTimes.length;
  }

  /** Starts drawing, now that there is something to draw. */
  release(): void {
    this.isHeld = false;
    if (this.requestedMs !== null) this.requestTick();
  }

  /** Redraws immediately after the canvas was resized, which clears it: it would flicker until the next frame. */
  redraw(detail: Detail): void {
    if (!this.isHeld) this.draw(detail);
  }

  /** Requests a frame because something changed. */
  invalidate(): void {
    if (this.requestedMs !== null) return;
    this.requestedMs = performance.now();
    this.requestTick();
  }

  /** Updates something outside the scene when the next frame is due; the scene is not drawn for it. */
  schedule(show: () => void): void {
    this.scheduledUpdates.add(show);
    this.requestTick();
  }

  private requestTick(): void {
    if (this.isTickRequested) return;
    this.isTickRequested = true;
    requestAnimationFrame(this.tick);
  }

  private readonly tick = (): void => {
    const nowMs = performance.now();
    const intervalMs = 1000 / Math.max(1, this.rate);
    const dueMs = this.dueMs;
    this.isTickRequested = false;
    if (nowMs < dueMs - TOLERANCE_MS) {
      this.requestTick();
      return;
    }
    // A late frame must not delay the frames after it, or each late frame would cost one.
    this.dueMs = Math.max(dueMs, nowMs - intervalMs) + intervalMs;
    const dueUpdates = [...this.scheduledUpdates];
    this.scheduledUpdates.clear();
    for (const show of dueUpdates) show();
    if (this.requestedMs === null || this.isHeld) return;
    if (this.frameCount >= FIRST_FRAME_COUNT) this.judge(nowMs - Math.max(this.requestedMs, dueMs));
    this.requestedMs = null;
    // The first frame must appear quickly.
    const level = Math.max(this.detailLevel, this.frameCount > 0 ? 0 : 1);
    this.paint(nowMs, level);
    clearTimeout(this.stillTimer);
    if (level > 0) this.stillTimer = window.setTimeout(() => this.paintStill(), STILL_AFTER_MS);
  };

  private judge(delayMs: number): void {
    const isLate = delayMs > LATE_MS;
    this.judged.emit(isLate);
    this.lateScore = Math.max(0, this.lateScore + (isLate ? 1 : -1));
    this.timelyCount = isLate ? 0 : this.timelyCount + 1;
    if (this.lateScore >= LATE_FRAME_COUNT) this.changeLevel(1);
    else if (this.timelyCount >= this.requiredTimelyCount && this.detailLevel > 0) {
      this.requiredTimelyCount *= 2;
      this.changeLevel(-1);
    }
  }

  private changeLevel(step: number): void {
    this.detailLevel = Math.min(this.detailLevel + step, DETAILS.length - 1);
    this.lateScore = this.timelyCount = 0;
  }

  private paintStill(): void {
    if (this.requestedMs === null) this.paint(performance.now(), 0);
  }

  private paint(nowMs: number, level: number): void {
    this.lastDrawnMs = nowMs;
    this.recentTimes.push(nowMs);
    this.draw(DETAILS[level] ?? FINEST_DETAIL);
    this.wasLastFrameFine = level === 0;
    this.frameCount += 1;
    this.drawn.emit();
  }
}
