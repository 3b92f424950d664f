import type { ImageFrame } from "../../protocol";

/** An image waiting to be painted. */
interface QueuedImage {
  image: ImageFrame | ImageBitmap;
  done: (shown: boolean) => void;
}

/** An image file waiting to be decoded. */
interface EncodedImage {
  turn: number;
  frame: ImageFrame;
  done: (shown: boolean) => void;
}

/**
 * The newest image of a display, on a canvas of its size. If image files arrive faster than they are decoded, only the
 * newest is decoded.
 */
export class ImageCanvas {
  readonly canvas = document.createElement("canvas");
  private readonly context: CanvasRenderingContext2D;
  private lastTurn = 0;
  private newest = 0;
  private painted = 0;
  private waiting: QueuedImage | null = null;
  private undecoded: EncodedImage | null = null;
  private isDecoding = false;

  /** `schedule` delays painting; only the newest image at that time is painted. */
  constructor(private readonly schedule: (paint: () => void) => void = (paint) => paint()) {
    this.canvas.width = this.canvas.height = 0;
    const context = this.canvas.getContext("2d", { willReadFrequently: true });
    if (!context) throw new Error("This browser gives no 2D canvas");
    this.context = context;
  }

  /** The number of images shown so far. */
  get count(): number {
    return this.painted;
  }

  get isEmpty(): boolean {
    return this.canvas.width === 0;
  }

  /** Shows an image; calls `done` when it is on the canvas, or with false if it cannot be decoded. */
  show(frame: ImageFrame, done: (shown: boolean) => void): void {
    const turn = ++this.lastTurn;
    if (frame.encoding !== "file") {
      this.queue(turn, { image: frame, done });
      return;
    }
    this.undecoded = { turn, frame, done };
    if (!this.isDecoding) void this.decode();
  }

  clear(): void {
    this.newest = ++this.lastTurn;
    this.undecoded = null;
    this.discard();
    this.canvas.width = this.canvas.height = 0;
  }

  /** Returns the color of a pixel, for tests. */
  colorAt(x: number, y: number): number[] {
    return this.isEmpty ? [] : [...this.context.getImageData(x, y, 1, 1).data];
  }

  /** Decodes one file at a time, because each needs memory for all its pixels. */
  private async decode(): Promise<void> {
    this.isDecoding = true;
    for (let next = this.undecoded; next !== null; next = this.undecoded) {
      this.undecoded = null;
      const { turn, frame, done } = next;
      try {
        const image = await createImageBitmap(new Blob([frame.data as Uint8Array<ArrayBuffer>]));
        this.queue(turn, { image, done });
      } catch {
        done(false);
      }
    }
    this.isDecoding = false;
  }

  private queue(turn: number, waiting: QueuedImage): void {
    const isOld = turn < this.newest;
    if (!isOld) {
      this.newest = turn;
      this.discard();
    }
    if (isOld || waiting.image.width === 0 || waiting.image.height === 0) {
      if (isBitmap(waiting.image)) waiting.image.close();
      return;
    }
    this.waiting = waiting;
    this.schedule(this.paint);
  }

  private discard(): void {
    if (this.waiting && isBitmap(this.waiting.image)) this.waiting.image.close();
    this.waiting = null;
  }

  private readonly paint = (): void => {
    const { waiting, canvas, context } = this;
    if (!waiting) return;
    const { image, done } = waiting;
    const [width, height] = isBitmap(image) ? [image.width, image.height] : [image.columns, image.rows];
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    if (isBitmap(image)) context.drawImage(image, 0, 0);
    else context.putImageData(new ImageData(rgbaOf(image), width, height), 0, 0);
    this.discard();
    this.painted += 1;
    done(true);
  };
}

function isBitmap(image: ImageFrame | ImageBitmap): image is ImageBitmap {
  return "close" in image;
}

/** Returns red, green, blue and alpha of each pixel. */
export function rgbaOf({ encoding, data }: ImageFrame): Uint8ClampedArray<ArrayBuffer> {
  if (encoding === "rgba") return new Uint8ClampedArray(data);
  const step = encoding === "grey" ? 1 : 3;
  const [green, blue] = encoding === "grey" ? [0, 0] : [1, 2];
  const result = new Uint32Array(data.length / step);
  for (let i = 0, at = 0; i < result.length; i++, at += step) {
    result[i] = 0xff000000 | ((data[at + blue] ?? 0) << 16) | ((data[at + green] ?? 0) << 8) | (data[at] ?? 0);
  }
  return new Uint8ClampedArray(result.buffer);
}
