import type { ImageFrame } from "../../protocol";

/** The newest image of a display, on a canvas of its size. */
export class PictureCanvas {
  readonly canvas = document.createElement("canvas");
  private readonly context: CanvasRenderingContext2D;
  private taken = 0;
  private shown = 0;
  private painted = 0;

  constructor() {
    this.canvas.width = this.canvas.height = 0;
    const context = this.canvas.getContext("2d", { willReadFrequently: true });
    if (!context) throw new Error("This browser gives no 2D canvas");
    this.context = context;
  }

  /** How many images it has shown. */
  get count(): number {
    return this.painted;
  }

  get isEmpty(): boolean {
    return this.canvas.width === 0;
  }

  /** Takes an image; `done` is told when it is on the canvas, or with false when it cannot be read. */
  take(frame: ImageFrame, done: (shown: boolean) => void): void {
    const turn = ++this.taken;
    if (frame.encoding !== "file") {
      this.paint(turn, frame.columns, frame.rows, () => {
        this.context.putImageData(new ImageData(pixels(frame), frame.columns, frame.rows), 0, 0);
      });
      done(true);
      return;
    }
    createImageBitmap(new Blob([frame.data as Uint8Array<ArrayBuffer>])).then(
      (bitmap) => {
        this.paint(turn, bitmap.width, bitmap.height, () => this.context.drawImage(bitmap, 0, 0));
        bitmap.close();
        done(true);
      },
      () => done(false),
    );
  }

  clear(): void {
    this.shown = this.taken;
    this.canvas.width = this.canvas.height = 0;
  }

  /** Colour of a pixel, for tests. */
  colorAt(x: number, y: number): number[] {
    return this.isEmpty ? [] : [...this.context.getImageData(x, y, 1, 1).data];
  }

  private paint(turn: number, width: number, height: number, draw: () => void): void {
    if (turn < this.shown || width === 0 || height === 0) return;
    this.shown = turn;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    draw();
    this.painted += 1;
  }
}

/** Red, green, blue and alpha of each pixel. */
export function pixels({ encoding, data }: ImageFrame): Uint8ClampedArray<ArrayBuffer> {
  if (encoding === "rgba") return new Uint8ClampedArray(data);
  const step = encoding === "grey" ? 1 : 3;
  const [green, blue] = encoding === "grey" ? [0, 0] : [1, 2];
  const result = new Uint32Array(data.length / step);
  for (let i = 0, at = 0; i < result.length; i++, at += step) {
    result[i] = 0xff000000 | ((data[at + blue] ?? 0) << 16) | ((data[at + green] ?? 0) << 8) | (data[at] ?? 0);
  }
  return new Uint8ClampedArray(result.buffer);
}
