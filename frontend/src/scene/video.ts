import { Signal } from "../signal";

const FRAME_RATE = 30;
/** The interval at which a still scene is redrawn: browsers record a canvas only when it is painted. */
const REDRAW_INTERVAL_MS = 100;
const BITS_PER_SECOND = 8_000_000;
/** The formats in order of preference. */
const MIME_TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/** Records a canvas as video; `redraw` repaints the canvas. */
export class VideoRecorder {
  /** Recording started, continued for another second, or stopped. */
  readonly changed = new Signal();
  private recorder: MediaRecorder | null = null;
  private startedMs = 0;
  private tickTimer = 0;
  private redrawTimer = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly redraw: () => void,
    private readonly onFinished: (video: Blob) => void,
  ) {}

  static get isPossible(): boolean {
    return typeof MediaRecorder !== "undefined" && MIME_TYPES.some((type) => MediaRecorder.isTypeSupported(type));
  }

  get isRecording(): boolean {
    return this.recorder !== null;
  }

  /** The duration so far, s. */
  get seconds(): number {
    return this.recorder ? Math.floor((performance.now() - this.startedMs) / 1000) : 0;
  }

  start(): void {
    if (this.recorder) return;
    const type = MIME_TYPES.find((candidate) => MediaRecorder.isTypeSupported(candidate)) ?? "";
    const stream = this.canvas.captureStream(FRAME_RATE);
    const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: BITS_PER_SECOND });
    const chunks: Blob[] = [];
    recorder.ondataavailable = ({ data }) => chunks.push(data);
    recorder.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      this.onFinished(new Blob(chunks, { type: recorder.mimeType }));
    };
    recorder.start(1000);
    this.recorder = recorder;
    this.startedMs = performance.now();
    this.redraw();
    this.redrawTimer = window.setInterval(this.redraw, REDRAW_INTERVAL_MS);
    this.tickTimer = window.setInterval(() => this.changed.emit(), 1000);
    this.changed.emit();
  }

  stop(): void {
    this.recorder?.stop();
    this.recorder = null;
    clearInterval(this.tickTimer);
    clearInterval(this.redrawTimer);
    this.changed.emit();
  }
}

/** Returns minutes and seconds. */
export function formatDuration(seconds: number): string {
  return `${Math.floor(seconds / 60)}:${String(seconds % 60).padStart(2, "0")}`;
}
