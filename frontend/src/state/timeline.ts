import type { Connection } from "../connection/connection";
import type { HistoryExtent, Playhead, Timeline } from "../protocol";
import { Signal } from "../signal";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10] as const;

/** A time span, s since the epoch. */
export interface Span {
  start: number;
  end: number;
}

/** The timeline: a recording that the server plays, or the history, with the playhead. */
export class TimelineState {
  readonly changed = new Signal();
  readonly moved = new Signal();
  private recording: Timeline | null = null;
  private playhead: Playhead | null = null;
  private historyExtent: HistoryExtent | null = null;
  /** The time to which the user moved, s; shown until the server reaches it. */
  private target: number | null = null;
  private isSeeking = false;
  private requestedPosition = 0;
  private marked: Span | null = null;
  /** The topic by whose messages to step; empty for all topics shown. */
  stepTopic = "";

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      // A new connection has no pending requests, and reports a timeline only if there is one.
      this.recording = this.playhead = this.historyExtent = this.target = this.marked = null;
      this.isSeeking = false;
      this.stepTopic = "";
      this.changed.emit();
    });
    connection.on("timeline", (timeline) => {
      this.recording = timeline;
      this.changed.emit();
    });
    connection.on("history_extent", (extent) => {
      this.historyExtent = extent;
      if (this.recording?.live) this.recording = { ...this.recording, start: extent.start, end: extent.end };
      this.moved.emit();
    });
    connection.on("playhead", (playhead) => this.setPlayhead(playhead));
  }

  /** The current timeline; null if there is none. */
  get timeline(): Timeline | null {
    return this.recording;
  }

  /** Whether live data is shown, so that time advances. */
  get live(): boolean {
    return this.playhead?.live ?? false;
  }

  /** The extent of the history; null for a recording. */
  get extent(): HistoryExtent | null {
    return this.historyExtent;
  }

  get playing(): boolean {
    return this.live || (this.playhead?.playing ?? false);
  }

  get speed(): number {
    return this.playhead?.speed ?? 1;
  }

  get loop(): boolean {
    return this.playhead?.loop ?? false;
  }

  /** Why the recording cannot be read any further; empty if it can. */
  get problem(): string {
    return this.playhead?.problem ?? "";
  }

  /** The time shown, s since the epoch. */
  get position(): number {
    if (this.live && this.target === null) return this.recording?.end ?? 0;
    return this.target ?? this.playhead?.position ?? this.recording?.start ?? 0;
  }

  /** The part of the history that the user marked, as far as the history still contains it. */
  get mark(): Span | null {
    const { recording, marked } = this;
    if (!recording?.live || !marked || marked.end <= recording.start) return null;
    return { start: Math.max(marked.start, recording.start), end: Math.min(marked.end, recording.end) };
  }

  /** Marks the part between two times in either order; null removes the mark. */
  setMark(mark: Span | null): void {
    this.marked = mark && { start: Math.min(mark.start, mark.end), end: Math.max(mark.start, mark.end) };
    this.changed.emit();
  }

  /** Moves the start or end of the mark to the time shown. */
  markHere(which: "start" | "end"): void {
    const { recording, position } = this;
    if (!recording?.live) return;
    const other = this.mark ?? { start: recording.start, end: recording.end };
    if (which === "start") this.setMark({ start: position, end: other.end > position ? other.end : recording.end });
    else this.setMark({ start: other.start < position ? other.start : recording.start, end: position });
  }

  play(playing: boolean): void {
    this.connection.send({ type: "play", playing });
  }

  goLive(): void {
    this.connection.send({ type: "go_live" });
  }

  step(forward: boolean): void {
    this.connection.send({ type: "step_time", forward, topic: this.stepTopic });
  }

  setSpeed(speed: number): void {
    this.connection.send({ type: "set_playback", speed, loop: this.loop });
  }

  setLoop(loop: boolean): void {
    this.connection.send({ type: "set_playback", speed: this.speed, loop });
  }

  /** Moves to a time. While the server is still processing a move, only the newest further one is kept. */
  seek(position: number): void {
    if (!this.recording) return;
    this.target = Math.min(this.recording.end, Math.max(this.recording.start, position));
    if (!this.isSeeking) this.requestSeek(this.target);
    this.moved.emit();
  }

  private requestSeek(position: number): void {
    this.isSeeking = true;
    this.requestedPosition = position;
    this.connection.send({ type: "seek_time", position });
  }

  private setPlayhead(playhead: Playhead): void {
    const before = this.playhead;
    this.playhead = playhead;
    if (this.isSeeking && before?.seeks !== playhead.seeks) {
      this.isSeeking = false;
      if (this.target !== null && this.target !== this.requestedPosition) this.requestSeek(this.target);
      else this.target = null;
    }
    const same = before !== null && (["playing", "live", "speed", "loop", "problem"] as const).every((key) => before[key] === playhead[key]);
    if (same) this.moved.emit();
    else this.changed.emit();
  }
}
