import { Signal } from "../signal";

/** Frames may come this much early and still count as keeping to the rate: screens do not tick evenly. */
const TOLERANCE_MS = 4;
/** With nothing drawn for this long the scene counts as idle. */
const IDLE_AFTER_MS = 600;
/** A frame that comes this long after it was due was held up by the ones before it: most of a tick of the screen. */
const LATE_MS = 12;
/** So many more late frames than timely ones make moving images coarser. */
const LATE_FRAMES = 4;
/** So many frames at the beginning do not show the pace: they wait for programs that are compiled. */
const FIRST_FRAMES = 6;
/** So many timely frames without a late one let them be finer again; twice as many the next time. */
const TIMELY_FRAMES = 300;
/** After a coarse frame, how long nothing must move until a fine one is drawn. */
const STILL_AFTER_MS = 250;

/** The detail of a frame: with or without antialiasing, and the share of the canvas's pixels along a side. */
export interface Detail {
  /** Of a moving image that the machine draws slowly: details that no user sees may be left out. */
  readonly moving: boolean;
  readonly smooth: boolean;
  readonly share: number;
}

export const FINEST: Detail = { moving: false, smooth: true, share: 1 };
const DETAILS: readonly Detail[] = [
  FINEST,
  { moving: true, smooth: false, share: 1 },
  { moving: true, smooth: false, share: 0.7 },
  { moving: true, smooth: false, share: 0.5 },
];

/**
 * Draws on demand: nothing while nothing changes, never more often than the rate. Where the machine does not keep up,
 * as software renderers, moving frames are drawn more and more coarsely, and a fine one follows when the scene is still.
 *
 * Content beside the scene with a rate of its own, as images of cameras, changes with the frames: browsers put
 * the whole page together for each change, which without a GPU costs as much as the scene does.
 */
export class FrameLoop {
  /** A frame was drawn. */
  readonly drawn = new Signal();
  /** One that was due: whether the ones before it held it up. */
  readonly judged = new Signal<boolean>();
  /** Largest number of frames a second. */
  rate = 30;
  private requestedAt: number | null = null;
  private readonly besides = new Set<() => void>();
  private ticks = false;
  /** When the next frame may be drawn. */
  private dueMs = -Infinity;
  private lateness = 0;
  private timely = 0;
  private patience = TIMELY_FRAMES;
  /** In `DETAILS`, of moving images. */
  private level = 0;
  private lastIsFine = false;
  private stillTimer = 0;
  private drawnAt = -Infinity;
  private recent: number[] = [];
  private count = 0;

  /**
   * @param held whether nothing is drawn before `release`: to a software renderer a frame of an empty scene is as much
   * work as one of a robot, which would be drawn later by that.
   */
  constructor(
    private readonly draw: (detail: Detail) => void,
    private held = false,
  ) {}

  /** Nothing changed since the last frame, beside the scene neither, and that was a fine one. */
  get settled(): boolean {
    return this.requestedAt === null && this.besides.size === 0 && this.lastIsFine;
  }

  /** Draws moving images coarsely from the first one on, as the renderer is known to be slow. */
  expectSlow(): void {
    this.level = Math.max(this.level, 1);
  }

  get framesDrawn(): number {
    return this.count;
  }

  /** Frames drawn in the last second, or null when the scene is idle. */
  framesPerSecond(nowMs: number): number | null {
    this.recent = this.recent.filter((at) => nowMs - at < 1000);
    return nowMs - this.drawnAt > IDLE_AFTER_MS ? null : this.recent.length;
  }

  /** There is something to draw. */
  release(): void {
    this.held = false;
    if (this.requestedAt !== null) this.askForTick();
  }

  /** Draws at once what a canvas showed before its size changed, which emptied it: it would flicker until the next frame. */
  redraw(detail: Detail): void {
    if (!this.held) this.draw(detail);
  }

  /** Something changed: a frame is due. */
  invalidate(): void {
    if (this.requestedAt !== null) return;
    this.requestedAt = performance.now();
    this.askForTick();
  }

  /** Has something shown beside the scene when the next frame is due; the scene is not drawn for it. */
  beside(show: () => void): void {
    this.besides.add(show);
    this.askForTick();
  }

  private askForTick(): void {
    if (this.ticks) return;
    this.ticks = true;
    requestAnimationFrame(this.tick);
  }

  private readonly tick = (): void => {
    const now = performance.now();
    const interval = 1000 / Math.max(1, this.rate);
    const due = this.dueMs;
    this.ticks = false;
    if (now < due - TOLERANCE_MS) {
      this.askForTick();
      return;
    }
    // One that comes late does not delay those after it, or each would cost a frame.
    this.dueMs = Math.max(due, now - interval) + interval;
    const besides = [...this.besides];
    this.besides.clear();
    for (const show of besides) show();
    if (this.requestedAt === null || this.held) return;
    if (this.count >= FIRST_FRAMES) this.judge(now - Math.max(this.requestedAt, due));
    this.requestedAt = null;
    // The first frame must come soon.
    const level = Math.max(this.level, this.count > 0 ? 0 : 1);
    this.paint(now, level);
    clearTimeout(this.stillTimer);
    if (level > 0) this.stillTimer = window.setTimeout(() => this.stand(), STILL_AFTER_MS);
  };

  private judge(delay: number): void {
    const late = delay > LATE_MS;
    this.judged.emit(late);
    this.lateness = Math.max(0, this.lateness + (late ? 1 : -1));
    this.timely = late ? 0 : this.timely + 1;
    if (this.lateness >= LATE_FRAMES) this.move(1);
    else if (this.timely >= this.patience && this.level > 0) {
      this.patience *= 2;
      this.move(-1);
    }
  }

  private move(coarser: number): void {
    this.level = Math.min(this.level + coarser, DETAILS.length - 1);
    this.lateness = this.timely = 0;
  }

  private stand(): void {
    if (this.requestedAt === null) this.paint(performance.now(), 0);
  }

  private paint(now: number, level: number): void {
    this.drawnAt = now;
    this.recent.push(now);
    this.draw(DETAILS[level] ?? FINEST);
    this.lastIsFine = level === 0;
    this.count += 1;
    this.drawn.emit();
  }
}
