import type { DisplayData } from "../../connection/data";
import type { ImageBoxes } from "../../protocol";
import type { DrawingContext } from "./drawing";
import { ImageDrawing } from "./image";

/** CSS pixels: lines and texts have the same size whatever the size of the image and the panel. */
const LINE_WIDTH_PX = 2;
const TEXT_HEIGHT_PX = 16;
const MAX_PENDING_BOXES = 10;

/** linkwright/Detections: an image with boxes over it. */
export class DetectionImageDrawing extends ImageDrawing {
  private readonly overlay = document.createElement("canvas");
  /** The boxes of images that are shown or not painted yet, by their stamps. */
  private readonly boxesByStamp = new Map<number, ImageBoxes>();
  /** The boxes of an image that is no longer available. */
  private unmatchedBoxes: ImageBoxes | null = null;
  private drawnTexts: string[] = [];

  constructor(context: DrawingContext) {
    super(context);
    this.overlay.className = "image-overlay";
    this.overlay.setAttribute("aria-hidden", "true");
    this.panel.element.append(this.overlay);
  }

  override onPropertiesChanged(): void {
    super.onPropertiesChanged();
    this.draw();
  }

  override onDataChanged(data: DisplayData): void {
    const { content, stamp } = data;
    if (content.kind === "image_boxes") {
      this.unmatchedBoxes = content.of_image ? null : content;
      if (content.of_image) this.boxesByStamp.set(stamp, content);
      for (const stamp of [...this.boxesByStamp.keys()].slice(0, -MAX_PENDING_BOXES)) this.boxesByStamp.delete(stamp);
      if (this.unmatchedBoxes) this.draw();
    } else super.onDataChanged(data);
  }

  override onDataRemoved(key: string | null): void {
    this.boxesByStamp.clear();
    this.unmatchedBoxes = null;
    if (key === "boxes") this.draw();
    else super.onDataRemoved(key);
  }

  override inspect(): object {
    return { ...super.inspect(), boxes: [...this.drawnTexts] };
  }

  /** Called when a new image is on the canvas. */
  protected override onPainted(): void {
    this.draw();
  }

  private draw(): void {
    const { overlay } = this;
    const boxes = this.boxesByStamp.get(this.imageStamp) ?? this.unmatchedBoxes;
    const { width, height } = this.size;
    const context = overlay.getContext("2d");
    if (!context || width === 0) return;
    const { clientWidth, clientHeight } = this.panel.element;
    const cssPixelsPerImagePixel = Math.min(clientWidth / width, clientHeight / height);
    if (cssPixelsPerImagePixel === 0) return;
    const scale = cssPixelsPerImagePixel * window.devicePixelRatio;
    overlay.width = Math.round(width * scale);
    overlay.height = Math.round(height * scale);
    this.drawnTexts = [];
    if (!boxes) return;
    context.scale(scale, scale);
    const { rows } = this.context.display;
    const threshold = rows.number(0, "Threshold");
    const showsScore = rows.bool(true, "Show Score");
    for (let i = 0; i < boxes.boxes.length / 5; i++) {
      const score = boxes.scores[i] ?? -1;
      if (score >= 0 && score < threshold) continue;
      const name = boxes.names[i] ?? "";
      const text = score < 0 ? name : `${name} ${score.toFixed(2)}`.trim();
      this.drawnTexts.push(text);
      drawBox(context, boxes, i, cssPixelsPerImagePixel, showsScore ? text : "");
    }
  }
}

/** Draws a box, with its text above the upper left corner, or inside the box if there is no room above. */
function drawBox(context: CanvasRenderingContext2D, { boxes, colors }: ImageBoxes, i: number, cssPixelsPerImagePixel: number, text: string): void {
  const [x = 0, y = 0, width = 0, height = 0, angle = 0] = boxes.subarray(5 * i, 5 * i + 5);
  const [red = 0, green = 0, blue = 0] = colors.subarray(3 * i, 3 * i + 3);
  const color = `rgb(${red} ${green} ${blue})`;
  context.save();
  context.translate(x, y);
  context.rotate(angle);
  context.strokeStyle = color;
  context.lineWidth = LINE_WIDTH_PX / cssPixelsPerImagePixel;
  context.strokeRect(-width / 2, -height / 2, width, height);
  if (text !== "") {
    const lineHeight = TEXT_HEIGHT_PX / cssPixelsPerImagePixel;
    context.font = `${0.75 * lineHeight}px sans-serif`;
    const top = y - height / 2 < lineHeight ? -height / 2 : -height / 2 - lineHeight;
    context.fillStyle = color;
    context.fillRect(-width / 2, top, context.measureText(text).width + lineHeight / 2, lineHeight);
    // Choose the text color for contrast: dark on light colors, light on dark ones.
    context.fillStyle = 0.3 * red + 0.59 * green + 0.11 * blue > 110 ? "#101010" : "#ffffff";
    context.textBaseline = "middle";
    context.fillText(text, -width / 2 + lineHeight / 4, top + lineHeight / 2);
  }
  context.restore();
}
