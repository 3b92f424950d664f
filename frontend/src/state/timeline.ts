import type { Connection } from "../connection/connection";
import type { HistoryExtent, Playhead, Timeline } from "../protocol";
import { Signal } from "../signal";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10] as const;

/** A time span, s since the epoch. */
export interface TimeSpan {
  start: number;
  end: number;
}

/** The timeline: a recording that the server plays, or the history, with the playhead. */
export class TimelineState {
  readonly changed = new Signal();
  readonly moved = new Signal();
  private currentTimeline: Timeline | null = null;
  private playhead: Playhead | null = null;
  private historyExtent: HistoryExtent | null = null;
  /** The time to which the user moved, s; shown until the server reaches it. */
  private target: number | null = null;
  private isSeeking = false;
  private requestedPosition = 0;
  private markedSpan: TimeSpan | null = null;
  /** The topic by whose messages to step; empty for all topics shown. */
  stepTopic = "";

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      // A new connection has no pending requests, and reports a timeline only if there is one.
      this.currentTimeline = this.playhead = this.historyExtent = this.target = this.markedSpan = null;
      this.isSeeking = false;
      this.stepTopic = "";
      this.changed.emit();
    });
    connection.on("timeline", (timeline) => {
      this.currentTimeline = timeline;
      this.changed.emit();
    });
    connection.on("history_extent", (extent) => {
      this.historyExtent = extent;
      if (this.currentTimeline?.live) this.currentTimeline = { ...this.currentTimeline, start: extent.start, end: extent.end };
      this.moved.emit();
    });
    connection.on("playhead", (playhead) => this.setPlayhead(playhead));
  }

  /** The current timeline; null if there is none. */
  get timeline(): Timeline | null {
    return this.currentTimeline;
  }

  /** Whether live data is shown, so that time advances. */
  get isLive(): boolean {
    return this.playhead?.live ?? false;
  }

  /** The extent of the history; null for a recording. */
  get extent(): HistoryExtent | null {
    return this.historyExtent;
  }

  get isPlaying(): boolean {
    return this.isLive || (this.playhead?.playing ?? false);
  }

  get speed(): number {
    return this.playhead?.speed ?? 1;
  }

  get isLooping(): boolean {
    return this.playhead?.loop ?? false;
  }

  /** Why the recording cannot be read any further; empty if it can. */
  get problem(): string {
    return this.playhead?.problem ?? "";
  }

  /** The time shown, s since the epoch. */
  get position(): number {
    if (this.isLive && this.target === null) return this.currentTimeline?.end ?? 0;
    return this.target ?? this.playhead?.position ?? this.currentTimeline?.start ?? 0;
  }

  /** The part of the history that the user marked, as far as the history still contains it. */
  get mark(): TimeSpan | null {
    const { currentTimeline, markedSpan } = this;
    if (!currentTimeline?.live || !markedSpan || markedSpan.end <= currentTimeline.start) return null;
    return { start: Math.max(markedSpan.start, currentTimeline.start), end: Math.min(markedSpan.end, currentTimeline.end) };
  }

  /** Marks the part between two times in either order; null removes the mark. */
  setMark(mark: TimeSpan | null): void {
    this.markedSpan = mark && { start: Math.min(mark.start, mark.end), end: Math.max(mark.start, mark.end) };
    this.changed.emit();
  }

  /** Moves the start or end of the mark to the time shown. */
  markHere(end: "start" | "end"): void {
    const { currentTimeline, position } = this;
    if (!currentTimeline?.live) return;
    const span = this.mark ?? { start: currentTimeline.start, end: currentTimeline.end };
    if (end === "start") this.setMark({ start: position, end: span.end > position ? span.end : currentTimeline.end });
    else this.setMark({ start: span.start < position ? span.start : currentTimeline.start, end: position });
  }

  setPlaying(isPlaying: boolean): void {
    this.connection.send({ type: "play", playing: isPlaying });
  }

  goLive(): void {
    this.connection.send({ type: "go_live" });
  }

  step(isForward: boolean): void {
    this.connection.send({ type: "step_time", forward: isForward, topic: this.stepTopic });
  }

  setSpeed(speed: number): void {
    this.connection.send({ type: "set_playback", speed, loop: this.isLooping });
  }

  setLoop(isLooping: boolean): void {
    this.connection.send({ type: "set_playback", speed: this.speed, loop: isLooping });
  }

  /** Moves to a time. While the server is still processing a move, only the newest further one is kept. */
  seek(position: number): void {
    if (!this.currentTimeline) return;
    this.target = Math.min(this.currentTimeline.end, Math.max(this.currentTimeline.start, position));
    if (!this.isSeeking) this.requestSeek(this.target);
    this.moved.emit();
  }

  private requestSeek(position: number): void {
    this.isSeeking = true;
    this.requestedPosition = position;
    this.connection.send({ type: "seek_time", position });
  }

  private setPlayhead(playhead: Playhead): void {
    const previous = this.playhead;
    this.playhead = playhead;
    if (this.isSeeking && previous?.seeks !== playhead.seeks) {
      this.isSeeking = false;
      if (this.target !== null && this.target !== this.requestedPosition) this.requestSeek(this.target);
      else this.target = null;
    }
    const isUnchanged = previous !== null && (["playing", "live", "speed", "loop", "problem"] as const).every((key) => previous[key] === playhead[key]);
    if (isUnchanged) this.moved.emit();
    else this.changed.emit();
  }
}
