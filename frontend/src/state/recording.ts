import type { Connection } from "../connection/connection";
import type { RecordedFile, RecordingState } from "../protocol";
import { Signal } from "../signal";

/** The recording that the server makes for pages: one at a time, which all of them see. */
export class RecordingControl {
  readonly changed = new Signal();
  /** This page's recording or saved excerpt is a file now. */
  readonly made = new Signal<RecordedFile>();
  /** A request of this page failed, or ended early; the reason. */
  readonly refused = new Signal<string>();
  /** The user requested to view a finished one. */
  readonly wanted = new Signal<RecordedFile>();
  private latest: RecordingState | null = null;
  private asked = false;

  constructor(private readonly connection: Connection) {
    connection.on("hello", () => {
      this.latest = null;
      this.asked = false;
      this.changed.emit();
    });
    connection.on("recording_state", (state) => this.take(state));
  }

  /** Whether topics can be recorded; not beside a recording that is shown. */
  get possible(): boolean {
    return this.latest?.possible ?? false;
  }

  get isRecording(): boolean {
    return (this.latest?.path ?? "") !== "";
  }

  /** The folder that is written, on the machine of the server. */
  get path(): string {
    return this.latest?.path ?? "";
  }

  /** The length of the recording, s. */
  get length(): number {
    return this.latest?.length ?? 0;
  }

  /** Bytes that are written. */
  get size(): number {
    return this.latest?.size ?? 0;
  }

  /** The part of the last minutes that is saved, 0 to 1; null while none is. */
  get saved(): number | null {
    return this.latest?.saved ?? null;
  }

  get problem(): string {
    return this.latest?.problem ?? "";
  }

  /** The recordings made since the program runs, the last first. */
  get files(): readonly RecordedFile[] {
    return this.latest?.files ?? [];
  }

  /** Records some topics; none for all current and future ones. */
  record(topics: readonly string[]): void {
    this.asked = true;
    this.connection.send({ type: "record_topics", topics: [...topics] });
  }

  stop(): void {
    this.asked = true;
    this.connection.send({ type: "stop_recording" });
  }

  /** Saves the messages of the last minutes between two times, s since the epoch; null for their ends. */
  save(start: number | null, end: number | null): void {
    this.asked = true;
    this.connection.send({ type: "save_minutes", start, end });
  }

  private take(state: RecordingState): void {
    const before = this.latest;
    this.latest = state;
    this.changed.emit();
    if (!this.asked || before === null) return;
    const [newest] = state.files;
    if (state.problem !== "" && state.problem !== before.problem) {
      this.asked = this.isRecording;
      this.refused.emit(state.problem);
    } else if (newest && newest.url !== before.files[0]?.url) {
      this.asked = this.isRecording;
      this.made.emit(newest);
    }
  }
}
