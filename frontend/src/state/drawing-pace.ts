import { Signal } from "../signal";

/** The number of recent frames that count. */
const FRAMES = 60;
/** So many late ones of them are slow, and so few are not any more. */
const SLOW = 45;
const FAST = 15;

/** Whether the page draws as fast as requested. Rare frames do not count as slow, only frames that were due. */
export class DrawingPace {
  /** Drawing became slow, or fast again. */
  readonly changed = new Signal();
  /** The software renderer, if the processor draws instead of a graphics card. */
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
