import { Vector3, type Box3 } from "three";
import { ThinLines } from "../objects/thin-lines";
import { ContentDrawing } from "./content-drawing";
import type { DrawingContext } from "./drawing";
import { colorOf } from "./styles";

/** rviz_default_plugins/Polygon: a closed line. */
export class PolygonDrawing extends ContentDrawing<"polygon_line"> {
  private readonly lines = new ThinLines();
  private cornerCount = 0;

  constructor(context: DrawingContext) {
    super(context, "polygon_line");
    this.root.add(this.lines.root);
  }

  dispose(): void {
    this.lines.dispose();
  }

  protected override inspectContents(): object {
    return { corners: this.cornerCount };
  }

  protected expandBox(box: Box3): void {
    this.lines.expandBox(box);
  }

  protected arrange(): void {
    const { rows } = this.context.display;
    const strips = this.listPosedContents().map(({ content, pose }) => {
      const ring = new Float32Array([...content.points, ...content.points.subarray(0, 3)]);
      for (let i = 0; i < ring.length; i += 3) new Vector3().fromArray(ring, i).applyMatrix4(pose).toArray(ring, i);
      return ring;
    });
    this.cornerCount = strips.reduce((sum, strip) => sum + Math.max(0, strip.length / 3 - 1), 0);
    this.lines.setStrips(strips);
    this.lines.setStyle(colorOf(rows, "#19ff00", "Color"), rows.number(1, "Alpha"));
  }
}
