import { Group } from "three";
import type { DisplayData } from "../../connection/data";
import { h } from "../../dom";
import type { OverlayFigure, OverlayShape } from "../../protocol";
import type { Drawing, DrawingContext } from "./drawing";

const LINE_HEIGHT = 1.2;

/** The displays of texts, gauges and images over the scene. */
export class OverlayDrawing implements Drawing {
  readonly root = new Group();
  readonly isElsewhere = true;
  private readonly canvas = h("canvas", { class: "figure", role: "img" });
  private figure: OverlayFigure | null = null;

  constructor(private readonly context: DrawingContext) {
    this.canvas.hidden = true;
    context.overScene.append(this.canvas);
  }

  onDataChanged({ content }: DisplayData): void {
    if (content.kind !== "overlay_figure") return;
    this.figure = content;
    this.show();
  }

  onDataRemoved(): void {
    this.figure = null;
    this.show();
  }

  onPropertiesChanged(): void {
    // The server sends the figure again.
  }

  update(): void {
    this.canvas.hidden = this.figure === null || !this.context.display.isEnabled;
  }

  inspect(): object {
    const { figure } = this;
    return { texts: figure?.shapes.flatMap(({ text }) => text || []) ?? [], shapes: figure?.shapes.length ?? 0, isShown: !this.canvas.hidden };
  }

  dispose(): void {
    this.canvas.remove();
  }

  private show(): void {
    const { canvas, figure } = this;
    this.update();
    if (!figure) return;
    const { x, y, width, height } = figure;
    canvas.setAttribute("aria-label", figure.label);
    Object.assign(canvas.style, { left: "", right: "", top: "", bottom: "", width: `${width}px`, height: `${height}px` });
    if (figure.horizontal === "center") canvas.style.left = `calc(50% + ${x - width / 2}px)`;
    else canvas.style[figure.horizontal] = `${x}px`;
    if (figure.vertical === "center") canvas.style.top = `calc(50% + ${y - height / 2}px)`;
    else canvas.style[figure.vertical] = `${y}px`;
    canvas.width = Math.max(1, Math.round(width * devicePixelRatio));
    canvas.height = Math.max(1, Math.round(height * devicePixelRatio));
    const context = canvas.getContext("2d");
    if (context) drawFigure(context, figure, devicePixelRatio);
  }
}

function drawFigure(context: CanvasRenderingContext2D, figure: OverlayFigure, pixelRatio: number): void {
  const { width, height, image_width: imageWidth, image_height: imageHeight } = figure;
  context.scale(pixelRatio, pixelRatio);
  context.fillStyle = toCss(figure.background);
  context.beginPath();
  context.roundRect(0, 0, width, height, figure.corner);
  context.fill();
  if (imageWidth > 0 && imageHeight > 0) {
    const image = new OffscreenCanvas(imageWidth, imageHeight);
    image.getContext("2d")?.putImageData(new ImageData(new Uint8ClampedArray(figure.pixels), imageWidth, imageHeight), 0, 0);
    context.drawImage(image, 0, 0, width, height);
  }
  for (const shape of figure.shapes) drawShape(context, shape);
}

function drawShape(context: CanvasRenderingContext2D, shape: OverlayShape): void {
  const { points, size } = shape;
  context.fillStyle = context.strokeStyle = toCss(shape.color);
  if (shape.shape === "text") {
    context.font = `bold ${size}px sans-serif`;
    context.textAlign = shape.align;
    context.textBaseline = "top";
    const lines = shape.text.split("\n").flatMap((line) => wrapLine(line, shape.wrap, (text) => context.measureText(text).width));
    const [x = 0, y = 0] = points;
    const top = shape.is_above ? y - lines.length * size * LINE_HEIGHT : y;
    lines.forEach((line, i) => context.fillText(line, x, top + i * size * LINE_HEIGHT));
    return;
  }
  context.beginPath();
  for (let i = 0; i + 1 < points.length; i += 2) context.lineTo(points[i] ?? 0, points[i + 1] ?? 0);
  if (shape.shape === "area") context.fill();
  else {
    context.lineWidth = size;
    context.stroke();
  }
}

/** Breaks a line between words so that no part is wider than `width`, if it is not 0; a long word stays whole. */
export function wrapLine(line: string, width: number, measure: (text: string) => number): string[] {
  if (width <= 0) return [line];
  const lines: string[] = [];
  let current = "";
  for (const word of line.split(" ")) {
    const longer = current === "" ? word : `${current} ${word}`;
    if (current !== "" && measure(longer) > width) {
      lines.push(current);
      current = word;
    } else current = longer;
  }
  return [...lines, current];
}

function toCss([red = 0, green = 0, blue = 0, alpha = 1]: readonly number[]): string {
  return `rgb(${[red, green, blue].map((component) => Math.round(component * 255)).join(" ")} / ${alpha})`;
}
