/** Limits a display to one update per Update Interval, and requests the frame for the next one. */
export class Pacing {
  private lastUpdateMs = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly invalidate: () => void) {}

  /** Whether a frame is scheduled. */
  get isWaiting(): boolean {
    return this.timer !== undefined;
  }

  /** Returns whether to update in a frame at this time; `intervalMs`, 0 for every frame. */
  shouldUpdate(nowMs: number, intervalMs: number): boolean {
    const waitMs = this.lastUpdateMs + intervalMs - nowMs;
    if (waitMs <= 0) {
      this.lastUpdateMs = nowMs;
      return true;
    }
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.invalidate();
    }, waitMs);
    return false;
  }

  /** Makes the next frame update regardless of the interval, so that changes by the user show immediately. */
  restart(): void {
    this.lastUpdateMs = -Infinity;
    clearTimeout(this.timer);
    this.timer = undefined;
  }
}
