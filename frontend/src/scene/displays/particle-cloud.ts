import { Matrix4, type Box3 } from "three";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";
import { ThinLines } from "../objects/thin-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { createFlatArrows } from "./flat-arrows";
import { colorOf, poseAt } from "./styles";

/** Dimensions of an arrow relative to the length of its shaft; axes are as thick as the shaft. */
const SHAFT_DIAMETER = 0.0435;
const HEAD_LENGTH = 0.3043;
const HEAD_DIAMETER = 0.1304;
const SEGMENT_COUNT = 8;

/** nav2_rviz_plugins/ParticleCloud: poses, drawn larger and higher the likelier they are. */
export class ParticleCloudDrawing extends ContentDrawing<"particle_marks"> {
  private readonly lines = new ThinLines();
  private readonly arrows = new ArrowBatch(this.root, SEGMENT_COUNT);
  private readonly axes = new AxesBatch(this.root, 1, SHAFT_DIAMETER, SEGMENT_COUNT);

  constructor(context: DrawingContext) {
    super(context, "particle_marks");
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
    const [posedContent] = this.listPosedContents();
    const frame = posedContent?.pose ?? new Matrix4();
    const weights: Float32Array = posedContent?.content.weights ?? new Float32Array(0);
    const poses = raiseByWeight(posedContent?.content.poses ?? new Float32Array(0), weights, rows.number(5, "Arrow Height Scale"));
    const [minLength, maxLength] = [rows.number(0.02, "Min Arrow Length"), rows.number(0.3, "Max Arrow Length")];
    const lengthOf = (i: number): number => minLength + (maxLength - minLength) * Math.min(Math.max(weights[i] ?? 0, 0), 1);
    const style = { color: colorOf(rows, "#ff1900", "Color"), alpha: rows.number(1, "Alpha") };
    const shape = rows.text("Arrow (Flat)", "Shape");
    const matrix = new Matrix4();
    this.arrows.begin(shape === "Arrow (3D)" ? weights.length : 0);
    this.axes.begin(shape === "Axes" ? weights.length : 0);
    for (let i = 0; i < weights.length; i++) {
      poseAt(poses, i, matrix).premultiply(frame);
      const length = lengthOf(i);
      if (shape === "Arrow (3D)") this.arrows.add(matrix, createArrowShape(length), style);
      else if (shape === "Axes") this.axes.add(matrix.multiply(new Matrix4().makeScale(length, length, length)));
    }
    this.arrows.end();
    this.axes.end();
    this.lines.setStyle(style.color, style.alpha);
    this.lines.setSegments(shape === "Arrow (Flat)" ? createFlatArrows(poses, frame, lengthOf) : new Float32Array(0));
  }
}

function createArrowShape(length: number): { shaftLength: number; shaftDiameter: number; headLength: number; headDiameter: number } {
  return {
    shaftLength: length,
    shaftDiameter: length * SHAFT_DIAMETER,
    headLength: length * HEAD_LENGTH,
    headDiameter: length * HEAD_DIAMETER,
  };
}

/**
 * Raises poses by their weights, as nav2 draws them. Their own height carries no information: they are on the ground.
 */
function raiseByWeight(poses: Float32Array, weights: Float32Array, scale: number): Float32Array {
  const raisedPoses = poses.slice();
  weights.forEach((weight, i) => (raisedPoses[i * 7 + 2] = weight * scale));
  return raisedPoses;
}
