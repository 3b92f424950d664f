import type { ImageFrame } from "../../protocol";

/** An image waiting to be painted. */
interface Waiting {
  image: ImageFrame | ImageBitmap;
  done: (shown: boolean) => void;
}

/** An image file waiting to be decoded. */
interface Packed {
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
  private taken = 0;
  private newest = 0;
  private painted = 0;
  private waiting: Waiting | null = null;
  private packed: Packed | null = null;
  private unpacks = false;

  /** `soon` schedules painting; only the newest image at that time is painted. */
  constructor(private readonly soon: (paint: () => void) => void = (paint) => paint()) {
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
  take(frame: ImageFrame, done: (shown: boolean) => void): void {
    const turn = ++this.taken;
    if (frame.encoding !== "file") {
      this.hold(turn, { image: frame, done });
      return;
    }
    this.packed = { turn, frame, done };
    if (!this.unpacks) void this.unpack();
  }

  clear(): void {
    this.newest = ++this.taken;
    this.packed = null;
    this.drop();
    this.canvas.width = this.canvas.height = 0;
  }

  /** Returns the colour of a pixel, for tests. */
  colorAt(x: number, y: number): number[] {
    return this.isEmpty ? [] : [...this.context.getImageData(x, y, 1, 1).data];
  }

  /** Decodes one file at a time, because each needs memory for all its pixels. */
  private async unpack(): Promise<void> {
    this.unpacks = true;
    for (let next = this.packed; next !== null; next = this.packed) {
      this.packed = null;
      const { turn, frame, done } = next;
      try {
        const image = await createImageBitmap(new Blob([frame.data as Uint8Array<ArrayBuffer>]));
        this.hold(turn, { image, done });
      } catch {
        done(false);
      }
    }
    this.unpacks = false;
  }

  private hold(turn: number, waiting: Waiting): void {
    const isOld = turn < this.newest;
    if (!isOld) {
      this.newest = turn;
      this.drop();
    }
    if (isOld || waiting.image.width === 0 || waiting.image.height === 0) {
      if (isBitmap(waiting.image)) waiting.image.close();
      return;
    }
    this.waiting = waiting;
    this.soon(this.paint);
  }

  private drop(): void {
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
    else context.putImageData(new ImageData(pixels(image), width, height), 0, 0);
    this.drop();
    this.painted += 1;
    done(true);
  };
}

function isBitmap(image: ImageFrame | ImageBitmap): image is ImageBitmap {
  return "close" in image;
}

/** Returns red, green, blue and alpha of each pixel. */
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
