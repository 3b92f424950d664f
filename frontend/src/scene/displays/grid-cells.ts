import { Group, Vector3, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import { findNearestPoint } from "../objects/nearest-point";
import { PointBatch } from "../objects/point-batch";
import type { PointLook } from "../objects/point-material";
import type { Hit } from "../picking";
import { readDataPose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";

/** rviz_default_plugins/GridCells: flat cells in the xy plane of their frame. */
export class GridCellsDrawing implements Drawing {
  readonly root = new Group();
  private data: DisplayData | null = null;
  private sides: readonly [number, number] = [0, 0];
  private readonly batch: PointBatch;

  constructor(private readonly context: DrawingContext) {
    this.batch = new PointBatch(this.readLook());
    this.root.matrixAutoUpdate = false;
    this.root.add(this.batch.root);
  }

  onPropertiesChanged(): void {
    this.batch.setLook(this.readLook());
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind !== "cell_grid") return;
    this.data = data;
    this.sides = [content.width, content.height];
    this.batch.setLook(this.readLook());
    this.batch.setPoints(content.positions, new Uint8Array(0), false);
  }

  onDataRemoved(): void {
    this.data = null;
    this.batch.setPoints(new Float32Array(0), new Uint8Array(0), false);
  }

  update(): void {
    if (!this.data) return;
    readDataPose(this.context.session.frames, this.data, this.root.matrix);
    this.root.matrixWorldNeedsUpdate = true;
  }

  pick({ ray }: Raycaster): Hit | null {
    const inverse = this.root.matrix.clone().invert();
    const origin = ray.origin.clone().applyMatrix4(inverse).toArray();
    const direction = ray.direction.clone().transformDirection(inverse).toArray();
    const nearestPoint = findNearestPoint(this.batch.positions, origin, direction, Math.max(...this.sides) / 2, 0);
    if (!nearestPoint) return null;
    const point = new Vector3().fromArray(this.batch.positions, nearestPoint.index * 3).applyMatrix4(this.root.matrix);
    return { key: "", distance: nearestPoint.distance, point, isGround: true };
  }

  inspect(): object {
    this.update();
    const firstCenter = new Vector3().fromArray(this.batch.positions).applyMatrix4(this.root.matrix);
    return { cells: this.batch.count, sides: [...this.sides], first: this.batch.count > 0 ? firstCenter.toArray() : null };
  }

  dispose(): void {
    this.batch.dispose();
  }

  private readLook(): PointLook {
    const { rows } = this.context.display;
    return {
      style: "Tiles",
      size: [this.sides[0], this.sides[1], 0],
      pixels: 1,
      perDepth: 0,
      color: rows.text("#19ff00", "Color"),
      alpha: rows.number(1, "Alpha"),
    };
  }
}
