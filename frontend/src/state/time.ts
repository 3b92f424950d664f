import type { Connection } from "../connection/connection";
import type { Clock, TimeState } from "../protocol";
import { Signal } from "../signal";

export type SyncMode = TimeState["mode"];

/** The four times of the Time panel, s. */
export interface Times {
  ros: number;
  rosElapsed: number;
  wall: number;
  wallElapsed: number;
}

/** Pause, synchronization and clocks, which the server has for all pages. */
export class TimeControlState {
  readonly changed = new Signal();
  readonly clockChanged = new Signal();
  /** The displays were cleared. */
  readonly displaysCleared = new Signal();
  isPaused = false;
  mode: SyncMode = "Off";
  source = "";
  sources: readonly string[] = [];
  private clock: Clock | null = null;
  private clockReceivedAt = 0;
  private isWatching = false;

  constructor(
    private readonly connection: Connection,
    private readonly now: () => number = () => performance.now(),
  ) {
    connection.on("time_state", ({ paused, mode, source, sources }) => {
      Object.assign(this, { isPaused: paused, mode, source, sources });
      this.changed.emit();
    });
    connection.on("clock", (clock) => {
      this.clock = clock;
      this.clockReceivedAt = this.now();
      this.clockChanged.emit();
    });
    connection.on("time_reset", () => this.displaysCleared.emit());
    // The server does not know this page's subscriptions after a reconnect.
    connection.on("hello", () => {
      if (this.isWatching) connection.send({ type: "watch_clock", watching: true });
    });
  }

  /** Returns the current times; null until the server has sent any. */
  computeTimes(): Times | null {
    if (!this.clock) return null;
    const { ros, ros_start, wall, wall_start, running } = this.clock;
    const elapsed = (this.now() - this.clockReceivedAt) / 1000;
    const rosNow = ros + (running ? elapsed : 0);
    const wallNow = wall + elapsed;
    return { ros: rosNow, rosElapsed: rosNow - ros_start, wall: wallNow, wallElapsed: wallNow - wall_start };
  }

  /** Starts or stops the server's reports of the clocks. */
  watch(isWatching: boolean): void {
    if (isWatching === this.isWatching) return;
    this.isWatching = isWatching;
    this.connection.send({ type: "watch_clock", watching: isWatching });
  }

  set(change: { paused?: boolean; mode?: SyncMode; source?: string }): void {
    const { paused, mode, source } = { paused: this.isPaused, mode: this.mode, source: this.source, ...change };
    this.connection.send({ type: "set_time", paused, mode, source });
  }

  /** Clears all displays, like RViz's Reset button. */
  reset(): void {
    this.connection.send({ type: "reset_time" });
  }
}
