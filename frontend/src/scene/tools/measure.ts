import { Vector3 } from "three";
import { strings } from "../../strings";
import { computePixelSize } from "../../state/views/camera";
import { distanceBetween, type Vector } from "../../state/views/vector";
import { LabelBatch } from "../objects/label-batch";
import { ThinLines } from "../objects/thin-lines";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

const DARK_YELLOW = "#808000";
/** The height of the label, CSS pixels. */
const LABEL_HEIGHT_PX = 20;

/**
 * RViz's Measure: the distance between two clicked points, which is also shown at the middle of the line; a right click
 * starts again.
 */
export class MeasureTool implements SceneTool {
  private readonly line = new ThinLines();
  private readonly label = new LabelBatch();
  private readonly stopListening: () => void;
  private start: Vector | null = null;
  private end: Vector | null = null;
  private isMeasuring = false;

  constructor(private readonly context: ToolContext) {
    context.stage.viewport.scene.add(this.line.root, this.label.root);
    // Draw the line and its label over the objects between its ends, which may be on two sides of a body.
    this.line.root.material.depthTest = false;
    this.line.root.renderOrder = 1;
    this.stopListening = context.session.view.changed.on(() => this.placeLabel());
    this.onSettingsChanged();
  }

  activate(): void {
    this.isMeasuring = false;
    this.context.setCursor("default");
    this.showLength();
  }

  onPointer(event: ToolEvent): void {
    if (event.type === "wheel" || event.type === "leave") return;
    const point = this.context.stage.picker.pointAt(event.x, event.y);
    this.context.setCursor(point ? "crosshair" : "default");
    if (this.isMeasuring && point) this.draw(point);
    if (event.type === "up" && event.button === "left") this.onRelease(point, event.isClick);
    if (event.type === "up" && event.button === "right") this.clear();
    this.showLength();
  }

  onSettingsChanged(): void {
    this.line.setStyle(this.context.state?.rows.text(DARK_YELLOW, "Line color") ?? DARK_YELLOW, 1);
    this.context.stage.loop.invalidate();
  }

  inspect(): object {
    return { length: this.length, start: this.start, end: this.end, label: this.labelText };
  }

  dispose(): void {
    this.stopListening();
    this.line.dispose();
    this.label.dispose();
    this.context.stage.loop.invalidate();
  }

  /** The distance, m; null before there are two points. */
  private get length(): number | null {
    return this.start && this.end ? distanceBetween(this.start, this.end) : null;
  }

  /** Handles the release of the button. A drag that ends over empty space is meant for the camera. */
  private onRelease(point: Vector | null, isClick: boolean): void {
    if (point) this.addPoint(point);
    if (point || isClick) this.context.showNotice(point ? "" : strings.tools.hints.nothingThere);
  }

  private addPoint(point: Vector): void {
    if (this.isMeasuring) this.isMeasuring = false;
    else {
      this.isMeasuring = true;
      this.start = point;
      this.draw(point);
    }
  }

  private draw(end: Vector): void {
    if (!this.start) return;
    this.end = end;
    this.line.setSegments(new Float32Array([...this.start, ...end]));
    this.placeLabel();
    this.context.stage.loop.invalidate();
  }

  private clear(): void {
    this.isMeasuring = false;
    this.start = this.end = null;
    this.line.setSegments(new Float32Array(0));
    this.placeLabel();
    this.context.stage.loop.invalidate();
  }

  private get labelText(): string {
    const { length } = this;
    return length === null || length === 0 ? "" : `${Number(length.toPrecision(4))} m`;
  }

  /** Places the label at the middle of the line, with the same size on the screen at any distance. */
  private placeLabel(): void {
    const { labelText, start, end } = this;
    this.label.begin(labelText.length);
    if (labelText !== "" && start && end) {
      const center = new Vector3(...start).add(new Vector3(...end)).multiplyScalar(0.5);
      const { session, stage } = this.context;
      const pixelSize = computePixelSize(session.view.camera, center.toArray(), stage.viewport.size);
      this.label.add(labelText, center, LABEL_HEIGHT_PX * pixelSize, 0, 1);
    }
    this.label.end();
  }

  private showLength(): void {
    const { length } = this;
    const lengthText = length !== null && length > 0 ? `[Length: ${Number(length.toPrecision(6))}m] ` : "";
    this.context.setHint(lengthText + strings.tools.hints.measure);
  }
}
