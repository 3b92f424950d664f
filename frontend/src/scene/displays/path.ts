import { Matrix4, Vector3, type Box3 } from "three";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";
import { ThinLines } from "../objects/thin-lines";
import { WideLines } from "../objects/wide-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf, poseAt } from "./styles";

const SEGMENT_COUNT = 10;

/** rviz_default_plugins/Path: lines through the poses of each path, and optionally the poses themselves. */
export class PathDrawing extends ContentDrawing<"pose_marks"> {
  private readonly thinLines = new ThinLines();
  private readonly wideLines = new WideLines();
  private readonly arrows = new ArrowBatch(this.root, SEGMENT_COUNT);
  private readonly axes = new AxesBatch(this.root);
  private pointCount = 0;

  constructor(context: DrawingContext) {
    super(context, "pose_marks");
    this.root.add(this.thinLines.root, this.wideLines.root);
  }

  dispose(): void {
    for (const batch of [this.thinLines, this.wideLines, this.arrows, this.axes]) batch.dispose();
  }

  protected override inspectContents(): object {
    return { points: this.pointCount, arrows: this.arrows.size, axes: this.axes.size, wide: this.wideLines.root.visible };
  }

  protected expandBox(box: Box3): void {
    for (const batch of [this.thinLines, this.wideLines, this.arrows, this.axes]) batch.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const offset = new Vector3(...rows.vector("Offset"));
    const paths = this.listPosedContents().map(({ content, pose }) => {
      const matrices = Array.from({ length: content.poses.length / 7 }, (_, i) => {
        const matrix = poseAt(content.poses, i, new Matrix4()).premultiply(pose);
        return matrix.setPosition(new Vector3().setFromMatrixPosition(matrix).add(offset));
      });
      return matrices;
    });
    const strips = paths.map((path) => {
      const points = new Float32Array(path.length * 3);
      path.forEach((matrix, i) => points.set(matrix.elements.slice(12, 15), i * 3));
      return points;
    });
    this.pointCount = strips.reduce((sum, strip) => sum + strip.length / 3, 0);
    const hasBillboards = rows.text("Lines", "Line Style") === "Billboards";
    const color = colorOf(rows, "#19ff00", "Color");
    const alpha = rows.number(1, "Alpha");
    this.thinLines.setStrips(hasBillboards ? [] : strips);
    this.thinLines.setStyle(color, alpha);
    this.wideLines.setStrips(hasBillboards ? strips : []);
    this.wideLines.setStyle(color, alpha, rows.number(0.03, "Line Width"));
    this.drawPoses(paths.flat());
  }

  private drawPoses(poses: readonly Matrix4[]): void {
    const { rows } = this.context.display;
    const style = rows.text("None", "Pose Style");
    const color = colorOf(rows, "#ff55ff", "Pose Color");
    const shape = {
      shaftLength: rows.number(0.1, "Shaft Length"),
      shaftDiameter: rows.number(0.1, "Shaft Diameter"),
      headLength: rows.number(0.2, "Head Length"),
      headDiameter: rows.number(0.3, "Head Diameter"),
    };
    this.axes.setShape(rows.number(0.3, "Length"), rows.number(0.03, "Radius"), SEGMENT_COUNT);
    this.arrows.begin(style === "Arrows" ? poses.length : 0);
    this.axes.begin(style === "Axes" ? poses.length : 0);
    for (const pose of poses) {
      if (style === "Arrows") this.arrows.add(pose, shape, { color });
      else if (style === "Axes") this.axes.add(pose);
    }
    this.arrows.end();
    this.axes.end();
  }
}
