import type { Connection } from "../connection/connection";
import type { RecordedFile, RecordingState } from "../protocol";
import { Signal } from "../signal";

/** The recording that the server makes for pages: one at a time, which all pages see. */
export class RecordingControl {
  readonly changed = new Signal();
  /** The recording or excerpt that this page requested is complete. */
  readonly finished = new Signal<RecordedFile>();
  /** A request of this page failed, or its recording ended early; the value is the reason. */
  readonly refused = new Signal<string>();
  /** The user asked to view a finished recording. */
  readonly viewRequested = new Signal<RecordedFile>();
  private latestState: RecordingState | null = null;
  private hasRequested = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.latestState = null;
      this.hasRequested = false;
      this.changed.emit();
    });
    connection.on("recording_state", (state) => this.setState(state));
  }

  /** Whether topics can be recorded, which is not the case while a recording is shown. */
  get isPossible(): boolean {
    return this.latestState?.possible ?? false;
  }

  get isRecording(): boolean {
    return (this.latestState?.path ?? "") !== "";
  }

  /** The folder being written, on the server's machine. */
  get path(): string {
    return this.latestState?.path ?? "";
  }

  /** The length of the recording, s. */
  get length(): number {
    return this.latestState?.length ?? 0;
  }

  /** The size written so far, bytes. */
  get size(): number {
    return this.latestState?.size ?? 0;
  }

  /** The saved share of the history, 0 to 1; null while nothing is being saved. */
  get savedShare(): number | null {
    return this.latestState?.saved ?? null;
  }

  get problem(): string {
    return this.latestState?.problem ?? "";
  }

  /** The recordings made since the program started, the newest first. */
  get files(): readonly RecordedFile[] {
    return this.latestState?.files ?? [];
  }

  /** Records the given topics; an empty list means all current and future topics. */
  record(topics: readonly string[]): void {
    this.hasRequested = true;
    this.connection.send({ type: "record_topics", topics: [...topics] });
  }

  stop(): void {
    this.hasRequested = true;
    this.connection.send({ type: "stop_recording" });
  }

  /** Saves the history between two times, s since the epoch; null for its start or end. */
  save(start: number | null, end: number | null): void {
    this.hasRequested = true;
    this.connection.send({ type: "save_minutes", start, end });
  }

  private setState(state: RecordingState): void {
    const previous = this.latestState;
    this.latestState = state;
    this.changed.emit();
    if (!this.hasRequested || previous === null) return;
    const [newestFile] = state.files;
    if (state.problem !== "" && state.problem !== previous.problem) {
      this.hasRequested = this.isRecording;
      this.refused.emit(state.problem);
    } else if (newestFile && newestFile.url !== previous.files[0]?.url) {
      this.hasRequested = this.isRecording;
      this.finished.emit(newestFile);
    }
  }
}
