import { Box3, Group, Matrix4, Plane, Quaternion, Vector3, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import type { OccupancyMap } from "../../protocol";
import { CellPlane } from "../objects/cell-plane";
import type { Hit } from "../picking";
import { readDataPose } from "../pose";
import type { Drawing, DrawingContext } from "./drawing";
import { createMapPalette, type MapScheme } from "./map-palette";

/** Maps are drawn before other transparent objects, and costmaps over maps. */
const RENDER_ORDERS: Readonly<Record<MapScheme, number>> = { map: -3, raw: -2, costmap: -1 };

/** rviz_default_plugins/Map */
export class MapDrawing implements Drawing {
  readonly root = new Group();
  private readonly plane = new CellPlane();
  private readonly origin = new Matrix4();
  private data: DisplayData | null = null;
  private map: OccupancyMap | null = null;
  private palette: Uint8Array = new Uint8Array(0);

  constructor(private readonly context: DrawingContext) {
    this.root.matrixAutoUpdate = false;
    this.root.add(this.plane.root);
    this.onPropertiesChanged();
  }

  onPropertiesChanged(): void {
    const { rows } = this.context.display;
    const scheme = rows.text("map", "Color Scheme") as MapScheme;
    const isBinary = rows.bool(false, "Binary representation");
    this.palette = createMapPalette(scheme, isBinary ? rows.number(100, "Binary threshold") : null);
    this.plane.setLook({
      palette: this.palette,
      alpha: rows.number(0.7, "Alpha"),
      isTranslucent: scheme !== "map",
      isBehind: rows.bool(false, "Draw Behind"),
      order: RENDER_ORDERS[scheme],
    });
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind !== "occupancy_map") return;
    this.data = data;
    this.map = content;
    this.plane.setCells(content.cells, content.width, content.height, content.resolution);
    const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = content.origin;
    this.origin.compose(new Vector3(x, y, z), new Quaternion(qx, qy, qz, qw).normalize(), new Vector3(1, 1, 1));
  }

  onDataRemoved(): void {
    this.data = this.map = null;
    this.plane.clear();
  }

  update(): void {
    if (!this.data) return;
    this.plane.root.visible = readDataPose(this.context.session.frames, this.data, this.root.matrix);
    this.root.matrix.multiply(this.origin);
    this.root.matrixWorldNeedsUpdate = true;
  }

  pick({ ray }: Raycaster): Hit | null {
    if (!this.map || !this.plane.root.visible) return null;
    const plane = new Plane(new Vector3(0, 0, 1), 0).applyMatrix4(this.root.matrix);
    const point = ray.intersectPlane(plane, new Vector3());
    if (!point) return null;
    const { x, y } = point.clone().applyMatrix4(this.root.matrix.clone().invert());
    const { width, height, resolution } = this.map;
    if (x < 0 || y < 0 || x > width * resolution || y > height * resolution) return null;
    return { key: "", distance: point.distanceTo(ray.origin), point, isGround: true };
  }

  /** The size in cells, such as `384 x 256`; empty without a map. */
  get size(): string {
    return this.map ? `${this.map.width} x ${this.map.height}` : "";
  }

  /** Returns the bounding box of the map in the fixed frame, m; empty if no map is shown. */
  computeBounds(): Box3 {
    this.update();
    return this.plane.root.visible ? new Box3().setFromPoints(this.computeCorners()) : new Box3();
  }

  private computeCorners(): Vector3[] {
    if (!this.map) return [];
    const { width, height, resolution } = this.map;
    const [x, y] = [width * resolution, height * resolution];
    return [[0, 0], [x, 0], [0, y], [x, y]].map(([x = 0, y = 0]) => new Vector3(x, y, 0).applyMatrix4(this.root.matrix));
  }

  inspect(): object {
    this.update();
    if (!this.map) return { cells: 0 };
    const { width, height, cells } = this.map;
    const [minimum, , , maximum] = this.computeCorners().map((corner) => corner.toArray());
    const counts: Record<number, number> = {};
    for (const value of cells) counts[value] = (counts[value] ?? 0) + 1;
    const colors = Object.keys(counts).map((value) => [
      Number(value),
      [...this.palette.subarray(Number(value) * 4, Number(value) * 4 + 4)],
    ]);
    return { cells: cells.length, width, height, bounds: [minimum, maximum], counts, colors: Object.fromEntries(colors) as object };
  }

  dispose(): void {
    this.plane.dispose();
  }
}
