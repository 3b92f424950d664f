import { Matrix4, type Box3 } from "three";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";
import { ThinLines } from "../objects/thin-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { createFlatArrows } from "./flat-arrows";
import { colorOf, poseAt } from "./styles";

/** A low number of segments, because thousands of poses are particles. */
const SEGMENT_COUNT = 8;

/** rviz_default_plugins/PoseArray */
export class PoseArrayDrawing extends ContentDrawing<"pose_marks"> {
  private readonly lines = new ThinLines();
  private readonly arrows = new ArrowBatch(this.root, SEGMENT_COUNT);
  private readonly axes = new AxesBatch(this.root);

  constructor(context: DrawingContext) {
    super(context, "pose_marks");
    this.root.add(this.lines.root);
  }

  dispose(): void {
    for (const batch of [this.lines, this.arrows, this.axes]) batch.dispose();
  }

  protected override inspectContents(): object {
    return { arrows: this.arrows.size, axes: this.axes.size };
  }

  protected expandBox(box: Box3): void {
    for (const batch of [this.lines, this.arrows, this.axes]) batch.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const shape = rows.text("Arrow (Flat)", "Shape");
    const [posedContent] = this.listPosedContents();
    const poses: Float32Array = posedContent?.content.poses ?? new Float32Array(0);
    const frame = posedContent?.pose ?? new Matrix4();
    const count = poses.length / 7;
    const color = colorOf(rows, "#ff1900", "Color");
    const alpha = rows.number(1, "Alpha");
    const arrow = {
      shaftLength: rows.number(0.23, "Shaft Length"),
      shaftDiameter: rows.number(0.01, "Shaft Radius"),
      headLength: rows.number(0.07, "Head Length"),
      headDiameter: rows.number(0.03, "Head Radius"),
    };
    const matrix = new Matrix4();
    this.axes.setShape(rows.number(0.3, "Axes Length"), rows.number(0.01, "Axes Radius"), SEGMENT_COUNT);
    this.arrows.begin(shape === "Arrow (3D)" ? count : 0);
    this.axes.begin(shape === "Axes" ? count : 0);
    for (let i = 0; i < count; i++) {
      poseAt(poses, i, matrix).premultiply(frame);
      if (shape === "Arrow (3D)") this.arrows.add(matrix, arrow, { color, alpha });
      else if (shape === "Axes") this.axes.add(matrix);
    }
    this.arrows.end();
    this.axes.end();
    this.lines.setStyle(color, alpha);
    const length = rows.number(0.3, "Arrow Length");
    this.lines.setSegments(shape === "Arrow (Flat)" ? createFlatArrows(poses, frame, () => length) : new Float32Array(0));
  }
}
