import type { Connection } from "../connection/connection";
import type { HistoryExtent, Playhead, Timeline } from "../protocol";
import { Signal } from "../signal";

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10] as const;

/** Two times, s since the epoch. */
export interface Span {
  start: number;
  end: number;
}

/** A recording that the server plays, or the messages of the last minutes: its times, and the playhead. */
export class TimelineState {
  readonly changed = new Signal();
  readonly moved = new Signal();
  private recording: Timeline | null = null;
  private playhead: Playhead | null = null;
  private extentNow: HistoryExtent | null = null;
  /** The time that the user seeks, s; shown until the server reaches it. */
  private target: number | null = null;
  private asked = false;
  private wanted = 0;
  private marked: Span | null = null;
  /** The topic whose messages are stepped by; empty for all shown topics. */
  stepTopic = "";

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      // A new connection knows no earlier requests; a program without a recording reports none.
      this.recording = this.playhead = this.extentNow = this.target = this.marked = null;
      this.asked = false;
      this.stepTopic = "";
      this.changed.emit();
    });
    connection.on("timeline", (timeline) => {
      this.recording = timeline;
      this.changed.emit();
    });
    connection.on("history_extent", (extent) => {
      this.extentNow = extent;
      if (this.recording?.live) this.recording = { ...this.recording, start: extent.start, end: extent.end };
      this.moved.emit();
    });
    connection.on("playhead", (playhead) => this.take(playhead));
  }

  /** The timeline that is shown; null where there is none. */
  get timeline(): Timeline | null {
    return this.recording;
  }

  /** Whether the present is shown, and time advances. */
  get live(): boolean {
    return this.playhead?.live ?? false;
  }

  /** The extent of the last minutes; null for a recording. */
  get extent(): HistoryExtent | null {
    return this.extentNow;
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

  /** Why it cannot be read on, or nothing. */
  get problem(): string {
    return this.playhead?.problem ?? "";
  }

  /** The time that is shown, s since the epoch. */
  get position(): number {
    if (this.live && this.target === null) return this.recording?.end ?? 0;
    return this.target ?? this.playhead?.position ?? this.recording?.start ?? 0;
  }

  /** The part of the last minutes that the user has marked, as far as it is still kept. */
  get mark(): Span | null {
    const { recording, marked } = this;
    if (!recording?.live || !marked || marked.end <= recording.start) return null;
    return { start: Math.max(marked.start, recording.start), end: Math.min(marked.end, recording.end) };
  }

  /** Marks the part between two times, whichever is the earlier; null for none. */
  setMark(mark: Span | null): void {
    this.marked = mark && { start: Math.min(mark.start, mark.end), end: Math.max(mark.start, mark.end) };
    this.changed.emit();
  }

  /** Has the mark begin, or end, at the time that is shown. */
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

  /** Goes to a time. While the server is on its way to one only the newest of the others is kept. */
  seek(position: number): void {
    if (!this.recording) return;
    this.target = Math.min(this.recording.end, Math.max(this.recording.start, position));
    if (!this.asked) this.ask(this.target);
    this.moved.emit();
  }

  private ask(position: number): void {
    this.asked = true;
    this.wanted = position;
    this.connection.send({ type: "seek_time", position });
  }

  private take(playhead: Playhead): void {
    const before = this.playhead;
    this.playhead = playhead;
    if (this.asked && before?.seeks !== playhead.seeks) {
      this.asked = false;
      if (this.target !== null && this.target !== this.wanted) this.ask(this.target);
      else this.target = null;
    }
    const same = before !== null && (["playing", "live", "speed", "loop", "problem"] as const).every((key) => before[key] === playhead[key]);
    if (same) this.moved.emit();
    else this.changed.emit();
  }
}
