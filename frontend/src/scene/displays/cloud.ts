import { Group, Matrix4, Vector3, type Raycaster } from "three";
import type { DisplayData } from "../../connection/data";
import { findNearestPoint } from "../objects/nearest-point";
import { PointBatch } from "../objects/point-batch";
import type { PointLook, PointStyle } from "../objects/point-material";
import { WireBoxes } from "../objects/wire-boxes";
import type { DescriptionRow, Hit, SelectionBox } from "../picking";
import { readDataPose } from "../pose";
import { describePoint } from "./cloud-description";
import type { Drawing, DrawingContext } from "./drawing";
import { PointFieldStore } from "./point-fields";

/** The radius around the pointer that picks points, as a share of half the scene's height: about 4 pixels. */
const POINTER_RADIUS = 0.012;
/** The maximum number of points that a rectangle selects. */
const MAX_SELECTED_POINTS = 1000;
/** The side of the mark around a selected point of the style Points, m. */
const POINT_MARK_SIZE_M = 0.004;

/** The points of one message. */
interface Cloud {
  data: DisplayData;
  batch: PointBatch;
  perDepth: number;
  /** Every `step`-th point was sent; 1 if all were. */
  step: number;
}

/**
 * rviz_default_plugins/PointCloud2, LaserScan, DepthCloud, FluidPressure, Illuminance, RelativeHumidity, Temperature.
 * Each message that Decay Time keeps visible has a batch of its own.
 */
export class CloudDrawing implements Drawing {
  readonly root = new Group();
  private readonly clouds = new Map<string, Cloud>();
  private readonly fields: PointFieldStore;
  private readonly marks = new WireBoxes();
  private selectedKeys: ReadonlySet<string> = new Set();

  constructor(private readonly context: DrawingContext) {
    this.fields = new PointFieldStore(context);
    this.root.add(this.marks.root);
  }

  onPropertiesChanged(): void {
    for (const cloud of this.clouds.values()) cloud.batch.setLook(this.readLook(cloud));
    this.markSelection();
  }

  onDataChanged(data: DisplayData): void {
    const { content } = data;
    if (content.kind !== "cloud_points") return;
    let cloud = this.clouds.get(data.key);
    if (cloud) {
      cloud.data = data;
      cloud.perDepth = content.pixel;
      cloud.step = content.step;
      cloud.batch.setLook(this.readLook(cloud));
    } else {
      const look = this.readLook({ perDepth: content.pixel });
      cloud = { data, batch: new PointBatch(look), perDepth: content.pixel, step: content.step };
      cloud.batch.root.matrixAutoUpdate = false;
      this.clouds.set(data.key, cloud);
      this.root.add(cloud.batch.root);
    }
    cloud.batch.setPoints(content.positions, content.colors, content.translucent);
    this.fields.forget(data.key);
    if (this.selectedKeys.size > 0) this.markSelection();
  }

  onDataRemoved(key: string | null): void {
    for (const [cloudKey, { batch }] of this.clouds) {
      if (key !== null && cloudKey !== key) continue;
      batch.dispose();
      this.clouds.delete(cloudKey);
      this.fields.forget(cloudKey);
    }
    this.markSelection();
  }

  update(): void {
    const { frames } = this.context.session;
    for (const { batch, data } of this.clouds.values()) {
      batch.root.visible = readDataPose(frames, data, batch.root.matrix);
      batch.root.matrixWorldNeedsUpdate = true;
    }
  }

  pick(ray: Raycaster): Hit | null {
    const [origin, direction] = [new Vector3(), new Vector3()];
    const inverse = new Matrix4();
    // Half the height of the visible area, m: at a distance of one meter, or at any distance for an orthographic
    // camera.
    const { elements } = this.context.getCamera().projectionMatrix;
    const pointerRadius = POINTER_RADIUS / elements[5];
    const isOrthographic = elements[15] === 1;
    let nearestHit: Hit | null = null;
    for (const [key, cloud] of this.clouds) {
      inverse.copy(cloud.batch.root.matrix).invert();
      origin.copy(ray.ray.origin).applyMatrix4(inverse);
      direction.copy(ray.ray.direction).transformDirection(inverse);
      const { style, size } = this.readLook(cloud);
      const radius = (style === "Points" ? 0 : size[0] / 2) + (isOrthographic ? pointerRadius : 0);
      const { positions } = cloud.batch;
      const nearestPoint = findNearestPoint(positions, origin.toArray(), direction.toArray(), radius, isOrthographic ? 0 : pointerRadius);
      if (!nearestPoint || (nearestHit && nearestHit.distance <= nearestPoint.distance)) continue;
      const point = new Vector3().fromArray(positions, nearestPoint.index * 3).applyMatrix4(cloud.batch.root.matrix);
      nearestHit = { key: `${key}:${nearestPoint.index}`, distance: nearestPoint.distance, point };
    }
    if (nearestHit && !this.context.display.rows.bool(true, "Selectable")) nearestHit.isGround = true;
    return nearestHit;
  }

  pickBox(box: SelectionBox): readonly string[] {
    const keys: string[] = [];
    if (!this.context.display.rows.bool(true, "Selectable")) return keys;
    const position = new Vector3();
    for (const [key, { batch }] of this.clouds) {
      for (let i = 0; i < batch.count && keys.length < MAX_SELECTED_POINTS; i++) {
        position.fromArray(batch.positions, i * 3).applyMatrix4(batch.root.matrix);
        if (box.hasPoint(position.x, position.y, position.z)) keys.push(`${key}:${i}`);
      }
    }
    return keys;
  }

  describe(key: string): DescriptionRow | null {
    const item = this.find(key);
    if (!item) return null;
    const { cloud, cloudKey, index } = item;
    const position = cloud.batch.positions.subarray(index * 3, index * 3 + 3);
    // The server numbers the points of the full cloud, also when the cloud is thinned for a slow connection.
    const pointNumber = index * cloud.step;
    return describePoint(pointNumber, cloudKey, position, this.fields.find(cloudKey, pointNumber));
  }

  positionOf(key: string): Vector3 | null {
    const item = this.find(key);
    if (!item) return null;
    const { positions, root } = item.cloud.batch;
    return new Vector3().fromArray(positions, item.index * 3).applyMatrix4(root.matrix);
  }

  highlight(keys: ReadonlySet<string>): void {
    this.selectedKeys = keys;
    this.markSelection();
  }

  inspect(): object {
    this.update();
    const clouds = [...this.clouds.values()];
    const bounds = computeBounds(clouds);
    const [first] = clouds;
    return {
      messages: clouds.length,
      points: clouds.reduce((sum, { batch }) => sum + batch.count, 0),
      bounds,
      step: first?.step ?? 1,
      firstColor: first ? [...first.batch.colors.subarray(0, 4)] : [],
      style: this.readLook({ perDepth: 0 }).style,
    };
  }

  dispose(): void {
    this.onDataRemoved(null);
    this.fields.dispose();
    this.marks.dispose();
  }

  private readLook({ perDepth }: { perDepth: number }): PointLook {
    const { rows } = this.context.display;
    const size = rows.number(0.01, "Size (m)");
    return {
      style: rows.text("Flat Squares", "Style") as PointStyle,
      size: [size, size, size],
      pixels: rows.number(3, "Size (Pixels)"),
      perDepth,
      color: rows.text("#ffffff", "Color"),
      alpha: rows.number(1, "Alpha"),
    };
  }

  private find(key: string): { cloud: Cloud; cloudKey: string; index: number } | null {
    const separator = key.lastIndexOf(":");
    const [cloudKey, index] = [key.slice(0, separator), Number(key.slice(separator + 1))];
    const cloud = this.clouds.get(cloudKey);
    return cloud && index < cloud.batch.count ? { cloud, cloudKey, index } : null;
  }

  /** Draws boxes around the selected points. */
  private markSelection(): void {
    const centers = [...this.selectedKeys].flatMap((key) => this.positionOf(key)?.toArray() ?? []);
    const { style, size } = this.readLook({ perDepth: 0 });
    this.marks.set(centers, style === "Points" ? POINT_MARK_SIZE_M : size[0]);
    this.context.invalidate();
  }
}

/** Returns the minimum and maximum corner of all points in the fixed frame, m; null if there are none. */
function computeBounds(clouds: readonly Cloud[]): [number[], number[]] | null {
  const minimum = new Vector3(Infinity, Infinity, Infinity);
  const maximum = minimum.clone().negate();
  const position = new Vector3();
  for (const { batch } of clouds) {
    for (let i = 0; i < batch.count; i++) {
      position.fromArray(batch.positions, i * 3).applyMatrix4(batch.root.matrix);
      minimum.min(position);
      maximum.max(position);
    }
  }
  return minimum.x === Infinity ? null : [minimum.toArray(), maximum.toArray()];
}
