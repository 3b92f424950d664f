import { Matrix4, type Box3 } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { createSphere } from "../objects/geometries";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf } from "./styles";

const SEGMENT_COUNT = 16;

/** rviz_default_plugins/PointStamped: spheres at the points; like RViz, this uses the property Radius as a diameter. */
export class PointStampedDrawing extends ContentDrawing<"point_marks"> {
  private readonly spheres = new CopyBatch(this.root, createSphere(SEGMENT_COUNT));

  constructor(context: DrawingContext) {
    super(context, "point_marks");
  }

  dispose(): void {
    this.spheres.dispose();
  }

  protected override inspectContents(): object {
    return { points: this.spheres.size };
  }

  protected expandBox(box: Box3): void {
    this.spheres.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const size = rows.number(0.2, "Radius");
    const alpha = rows.number(1, "Alpha");
    const color = colorOf(rows, "#cc29cc", "Color");
    const contents = this.listPosedContents();
    const matrix = new Matrix4();
    this.spheres.begin(contents.reduce((sum, { content }) => sum + content.positions.length / 3, 0));
    for (const { content, pose } of contents) {
      for (let i = 0; i < content.positions.length; i += 3) {
        const [x = 0, y = 0, z = 0] = content.positions.subarray(i, i + 3);
        matrix.makeScale(size, size, size).setPosition(x, y, z).premultiply(pose);
        this.spheres.add(matrix, 0, alpha, color);
      }
    }
    this.spheres.end();
  }
}
