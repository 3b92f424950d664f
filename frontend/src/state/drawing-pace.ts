import { Signal } from "../signal";

/** So many frames are looked back at. */
const FRAMES = 60;
/** So many late ones of them are slow, and so few are not any more. */
const SLOW = 45;
const FAST = 15;

/** Whether the page draws as fast as it is asked to. What comes seldom is not slow: only frames count that were due. */
export class DrawingPace {
  /** It became slow, or is no longer. */
  readonly changed = new Signal();
  /** What draws, where that is the processor and no graphics card. */
  software: string | null = null;
  private readonly lates: boolean[] = [];
  private slow = false;

  get isSlow(): boolean {
    return this.slow;
  }

  /** A frame was drawn; `late`: long after it was due, for the ones before it took their time. */
  frame(late: boolean): void {
    this.lates.push(late);
    if (this.lates.length > FRAMES) this.lates.shift();
    const count = this.lates.filter(Boolean).length;
    const slow = this.slow ? count > FAST : count >= SLOW;
    if (slow === this.slow) return;
    this.slow = slow;
    this.changed.emit();
  }
}
