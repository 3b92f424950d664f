import type { ImageFrame } from "../../protocol";

/** An image waiting to be painted. */
interface QueuedImage {
  image: ImageFrame | ImageBitmap;
  onDone: (isShown: boolean) => void;
}

/** An image file waiting to be decoded. */
interface EncodedImage {
  imageNumber: number;
  frame: ImageFrame;
  onDone: (isShown: boolean) => void;
}

/**
 * The newest image of a display, on a canvas of its size. If image files arrive faster than they are decoded, only the
 * newest is decoded.
 */
export class ImageCanvas {
  readonly canvas = document.createElement("canvas");
  private readonly context: CanvasRenderingContext2D;
  private lastImageNumber = 0;
  private newestShownNumber = 0;
  private paintedCount = 0;
  private queuedImage: QueuedImage | null = null;
  private pendingImage: EncodedImage | null = null;
  private isDecoding = false;

  /** `schedule` delays painting; only the newest image at that time is painted. */
  constructor(private readonly schedule: (paint: () => void) => void = (paint) => paint()) {
    this.canvas.width = this.canvas.height = 0;
    const context = this.canvas.getContext("2d", { willReadFrequently: true });
    if (!context) throw new Error("This browser does not support the 2D canvas");
    this.context = context;
  }

  /** The number of images shown so far. */
  get count(): number {
    return this.paintedCount;
  }

  get isEmpty(): boolean {
    return this.canvas.width === 0;
  }

  /** Shows an image; calls `onDone` when it is on the canvas, or with false if it cannot be decoded. */
  show(frame: ImageFrame, onDone: (isShown: boolean) => void): void {
    const imageNumber = ++this.lastImageNumber;
    if (frame.encoding !== "file") {
      this.queue(imageNumber, { image: frame, onDone });
      return;
    }
    this.pendingImage = { imageNumber, frame, onDone };
    if (!this.isDecoding) void this.decode();
  }

  clear(): void {
    this.newestShownNumber = ++this.lastImageNumber;
    this.pendingImage = null;
    this.discardQueued();
    this.canvas.width = this.canvas.height = 0;
  }

  /** Returns the color of a pixel, for tests. */
  colorAt(x: number, y: number): number[] {
    return this.isEmpty ? [] : [...this.context.getImageData(x, y, 1, 1).data];
  }

  /** Decodes one file at a time, because each needs memory for all its pixels. */
  private async decode(): Promise<void> {
    this.isDecoding = true;
    for (let encodedImage = this.pendingImage; encodedImage !== null; encodedImage = this.pendingImage) {
      this.pendingImage = null;
      const { imageNumber, frame, onDone } = encodedImage;
      try {
        const image = await createImageBitmap(new Blob([frame.data as Uint8Array<ArrayBuffer>]));
        this.queue(imageNumber, { image, onDone });
      } catch {
        onDone(false);
      }
    }
    this.isDecoding = false;
  }

  private queue(imageNumber: number, queuedImage: QueuedImage): void {
    const isOutdated = imageNumber < this.newestShownNumber;
    if (!isOutdated) {
      this.newestShownNumber = imageNumber;
      this.discardQueued();
    }
    if (isOutdated || queuedImage.image.width === 0 || queuedImage.image.height === 0) {
      if (isBitmap(queuedImage.image)) queuedImage.image.close();
      return;
    }
    this.queuedImage = queuedImage;
    this.schedule(this.paint);
  }

  private discardQueued(): void {
    if (this.queuedImage && isBitmap(this.queuedImage.image)) this.queuedImage.image.close();
    this.queuedImage = null;
  }

  private readonly paint = (): void => {
    const { queuedImage, canvas, context } = this;
    if (!queuedImage) return;
    const { image, onDone } = queuedImage;
    const [width, height] = isBitmap(image) ? [image.width, image.height] : [image.columns, image.rows];
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    if (isBitmap(image)) context.drawImage(image, 0, 0);
    else context.putImageData(new ImageData(convertToRgba(image), width, height), 0, 0);
    this.discardQueued();
    this.paintedCount += 1;
    onDone(true);
  };
}

function isBitmap(image: ImageFrame | ImageBitmap): image is ImageBitmap {
  return "close" in image;
}

/** Returns red, green, blue and alpha of each pixel. */
export function convertToRgba({ encoding, data }: ImageFrame): Uint8ClampedArray<ArrayBuffer> {
  if (encoding === "rgba") return new Uint8ClampedArray(data);
  const channelCount = encoding === "gray" ? 1 : 3;
  const [green, blue] = encoding === "gray" ? [0, 0] : [1, 2];
  const pixels = new Uint32Array(data.length / channelCount);
  for (let i = 0, position = 0; i < pixels.length; i++, position += channelCount) {
    pixels[i] = 0xff000000 | ((data[position + blue] ?? 0) << 16) | ((data[position + green] ?? 0) << 8) | (data[position] ?? 0);
  }
  return new Uint8ClampedArray(pixels.buffer);
}
