import { Matrix4, type Box3 } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { createCone } from "../objects/geometries";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf } from "./styles";

const SEGMENT_COUNT = 32;

/** rviz_default_plugins/Range: cones with their apex at the sensor. */
export class RangeDrawing extends ContentDrawing<"range_cone"> {
  private readonly cones = new CopyBatch(this.root, createCone(SEGMENT_COUNT));

  constructor(context: DrawingContext) {
    super(context, "range_cone");
  }

  dispose(): void {
    this.cones.dispose();
  }

  protected override inspectContents(): object {
    return { cones: this.cones.size };
  }

  protected expandBox(box: Box3): void {
    this.cones.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const color = colorOf(rows, "#ffffff", "Color");
    const alpha = rows.number(0.5, "Alpha");
    const contents = this.listPosedContents();
    const [shape, size] = [new Matrix4(), new Matrix4()];
    this.cones.begin(contents.length);
    for (const { content, pose } of contents) {
      const { range, field_of_view } = content;
      if (range <= 0) continue;
      const width = 2 * range * Math.tan(field_of_view / 2);
      // The batch's cone has its base at the origin and its apex along x: turn it so that the apex is at the sensor.
      shape.makeTranslation(range, 0, 0).multiply(size.makeScale(-range, -width, width));
      this.cones.add(shape.premultiply(pose), 0, alpha, color);
    }
    this.cones.end();
  }
}
