import { Matrix4, Vector3, type Box3, type Raycaster } from "three";
import type { PoseMarks } from "../../protocol";
import { describeNumbers } from "../described-pose";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";
import { CovarianceBatch } from "../objects/covariance-batch";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { ContentDrawing, type PosedContent } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf, readCovarianceStyle, readArrowShape, poseAt } from "./styles";

/** rviz_default_plugins/Pose, PoseWithCovariance and Odometry: poses as arrows or axes, with their covariances. */
export class PosesDrawing extends ContentDrawing<"pose_marks"> {
  private readonly arrows = new ArrowBatch(this.root);
  private readonly axes = new AxesBatch(this.root);
  private readonly covariances = new CovarianceBatch(this.root);

  private drawnContents: readonly PosedContent<PoseMarks>[] = [];

  constructor(context: DrawingContext) {
    super(context, "pose_marks");
  }

  pick(ray: Raycaster): Hit | null {
    const hit = this.arrows.pick(ray) ?? this.axes.pick(ray);
    const drawnContent = hit && this.drawnContents[hit.copy];
    return hit && drawnContent ? { key: drawnContent.key, distance: hit.distance, point: hit.point } : null;
  }

  pickBox(box: SelectionBox): readonly string[] {
    return this.drawnContents.flatMap((drawnContent) => {
      const position = computePosition(drawnContent);
      return box.hasPoint(position.x, position.y, position.z) ? [drawnContent.key] : [];
    });
  }

  positionOf(key: string): Vector3 | null {
    const drawnContent = this.drawnContents.find((drawnContent) => drawnContent.key === key);
    return drawnContent ? computePosition(drawnContent) : null;
  }

  /** Returns a pose as in RViz's Selection panel: in the frame of its message. */
  describe(key: string): DescriptionRow | null {
    const drawnContent = this.drawnContents.find((drawnContent) => drawnContent.key === key);
    if (!drawnContent) return null;
    const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 0] = drawnContent.content.poses;
    const children = [
      { name: "Frame", value: drawnContent.frame },
      describeNumbers("Position", { X: x, Y: y, Z: z }),
      describeNumbers("Orientation", { X: qx, Y: qy, Z: qz, W: qw }),
    ];
    const { covariances } = drawnContent.content;
    if (covariances.length > 0) {
      const varianceOf = (i: number): number => covariances[i * 7] ?? 0;
      children.push(describeNumbers("Covariance Position", { X: varianceOf(0), Y: varianceOf(1), Z: varianceOf(2) }));
      children.push(describeNumbers("Covariance Orientation", { X: varianceOf(3), Y: varianceOf(4), Z: varianceOf(5) }));
    }
    return { name: `Pose ${this.context.display.name}`, children };
  }

  dispose(): void {
    for (const batch of [this.arrows, this.axes, this.covariances]) batch.dispose();
  }

  protected override inspectContents(): object {
    return { arrows: this.arrows.size, axes: this.axes.size };
  }

  protected expandBox(box: Box3): void {
    for (const batch of [this.arrows, this.axes, this.covariances]) batch.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    // In Odometry, the sizes are below Shape.
    const parentPath = rows.find("Shape")?.children.length ? ["Shape"] : [];
    const areArrows = rows.text("Arrow", "Shape") === "Arrow";
    const shape = readArrowShape(rows, parentPath);
    const arrowStyle = { color: colorOf(rows, "#ff1900", ...parentPath, "Color"), alpha: rows.number(1, ...parentPath, "Alpha") };
    const style = readCovarianceStyle(rows);
    const contents = this.listPosedContents();
    this.drawnContents = contents;
    const count = contents.reduce((sum, { content }) => sum + content.poses.length / 7, 0);
    const matrix = new Matrix4();
    this.axes.setShape(rows.number(1, ...parentPath, "Axes Length"), rows.number(0.1, ...parentPath, "Axes Radius"));
    this.arrows.begin(areArrows ? count : 0);
    this.axes.begin(areArrows ? 0 : count);
    this.covariances.begin(style ? count : 0);
    for (const { content, pose } of contents) {
      const { poses, covariances } = content;
      for (let i = 0; i < poses.length / 7; i++) {
        poseAt(poses, i, matrix).premultiply(pose);
        if (areArrows) this.arrows.add(matrix, shape, arrowStyle);
        else this.axes.add(matrix);
        const covariance = covariances.subarray(i * 36, i * 36 + 36);
        if (style && covariance.length > 0) {
          this.covariances.add(pose, poses.subarray(i * 7, i * 7 + 7), covariance, style);
        }
      }
    }
    for (const batch of [this.arrows, this.axes, this.covariances]) batch.end();
  }
}

/** Returns the position of the single pose of a content. */
function computePosition({ content, pose }: PosedContent<PoseMarks>): Vector3 {
  return new Vector3().setFromMatrixPosition(poseAt(content.poses, 0, new Matrix4()).premultiply(pose));
}
