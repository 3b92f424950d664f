/** Limits a display to one update in its Update Interval, and asks for the frame that is then due. */
export class Pacing {
  private last = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly invalidate: () => void) {}

  /** Whether a frame is still to be asked for. */
  get waiting(): boolean {
    return this.timer !== undefined;
  }

  /** Whether to update in the frame of this moment; `interval` in milliseconds, 0 for every frame. */
  due(now: number, interval: number): boolean {
    const wait = this.last + interval - now;
    if (wait <= 0) {
      this.last = now;
      return true;
    }
    this.timer ??= setTimeout(() => {
      this.timer = undefined;
      this.invalidate();
    }, wait);
    return false;
  }

  /** Makes the next frame update whatever the interval: what the user changes shows at once. */
  restart(): void {
    this.last = -Infinity;
    clearTimeout(this.timer);
    this.timer = undefined;
  }
}
