import { BufferGeometry, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments } from "three";
import { FIXED_FRAME } from "../../state/view";
import { WideLines } from "../objects/wide-lines";
import { readFramePose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";
import { createGridLines, splitLines, createFadedColors } from "./grid-lines";

/** The maximum number of pieces of a line; up to it, a line has one piece for each cell. */
const MAX_PIECES_PER_LINE = 20;

/** rviz_default_plugins/Grid */
export class GridDrawing implements Drawing {
  readonly root = new Group();
  private readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  private readonly billboards = new WideLines();
  private frame = "";
  private isFading = false;

  constructor(private readonly context: DrawingContext) {
    this.root.matrixAutoUpdate = false;
    this.root.add(this.lines, this.billboards.root);
    this.onPropertiesChanged();
  }

  onPropertiesChanged(): void {
    const { rows } = this.context.display;
    const cells = rows.number(10, "Plane Cell Count");
    const segments = createGridLines({
      cells,
      normalCells: rows.number(0, "Normal Cell Count"),
      cellSize: rows.number(1, "Cell Size"),
      plane: rows.text("XY", "Plane"),
    });
    const color = rows.text("#a0a0a4", "Color");
    const alpha = rows.number(0.5, "Alpha");
    const hasBillboards = rows.text("Lines", "Line Style") === "Billboards";
    const offset = rows.vector("Offset");
    this.lines.visible = !hasBillboards;
    this.lines.position.set(...offset);
    this.billboards.root.position.set(...offset);
    this.billboards.setSegments(hasBillboards ? segments : new Float32Array(0));
    this.billboards.setStyle(color, alpha, rows.number(0.03, "Line Style", "Line Width"));
    const pieces = hasBillboards ? new Float32Array(0) : splitLines(segments, Math.max(1, Math.min(cells, MAX_PIECES_PER_LINE)));
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(pieces, 3));
    this.isFading = this.context.session.displays.hasBackdrop;
    const colors = this.isFading ? createFadedColors(pieces) : null;
    if (colors) this.lines.geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
    this.lines.material.vertexColors = colors !== null;
    this.lines.material.color.set(color);
    this.lines.material.opacity = alpha;
    this.lines.material.transparent = alpha < 1 || this.isFading;
    this.lines.material.depthWrite = alpha >= 1 && !this.isFading;
    this.lines.material.needsUpdate = true;
    this.frame = rows.text(FIXED_FRAME, "Reference Frame");
  }

  inspect(): object {
    return { offset: this.lines.position.toArray(), cell: this.context.display.rows.number(1, "Cell Size") };
  }

  update(): void {
    const { frames, displays } = this.context.session;
    if (displays.hasBackdrop !== this.isFading) this.onPropertiesChanged();
    if (this.frame === FIXED_FRAME || this.frame === displays.fixedFrame) {
      this.root.matrix.identity();
    } else {
      // Without a transform, RViz leaves the grid in place.
      readFramePose(frames, frames.rowOf(this.frame), this.root.matrix);
    }
    this.root.matrixWorldNeedsUpdate = true;
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
    this.billboards.dispose();
  }
}
