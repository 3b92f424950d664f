import { Color, Matrix4, Mesh, Vector3, type Box3, type BufferGeometry, type Object3D } from "three";
import type { MarkerShape } from "../../protocol";
import { MIN_OPAQUE_ALPHA } from "../materials";
import { poseAlongX, ArrowBatch, type ArrowShape } from "../objects/arrow-batch";
import { CopyBatch } from "../objects/copy-batch";
import { paint, unitBox, unitCylinder, unitSphere } from "../objects/geometries";

/** The proportions of an arrow marker without points, before its scale. */
const DEFAULT_ARROW: ArrowShape = { shaftLength: 0.77, shaftDiameter: 1, headLength: 0.23, headDiameter: 2 };
/** The share of the head in an arrow between points, if the marker does not specify it. */
const HEAD_SHARE = 0.23;
const STRIP_HEAD_SHARE = 0.25;
/** The unit shapes; spheres and cylinders have a radius of one, so that their scale must be halved. */
const SHAPES: Readonly<Record<string, { geometry: BufferGeometry; isHalved: readonly [boolean, boolean, boolean] }>> = {
  cube: { geometry: unitBox, isHalved: [false, false, false] },
  sphere: { geometry: unitSphere, isHalved: [true, true, true] },
  cylinder: { geometry: unitCylinder, isHalved: [true, true, false] },
};

const SOLID_SHAPES: ReadonlySet<MarkerShape["shape"]> = new Set<MarkerShape["shape"]>([
  "arrow",
  "arrow_strip",
  "cube",
  "cylinder",
  "sphere",
  "cube_list",
  "sphere_list",
]);

/** Whether markers of this shape are drawn by `SolidMarkers`. */
export function isSolid(kind: MarkerShape["shape"]): boolean {
  return SOLID_SHAPES.has(kind);
}

/** The copies of one shape. Transparent ones are in a batch of their own, because they must not write depth. */
class ShapeCopies {
  private readonly batches: { opaqueBatch: CopyBatch; translucentBatch: CopyBatch };
  private readonly copies: { matrix: Matrix4; alpha: number; color: number }[] = [];

  constructor(parent: Object3D, geometry: BufferGeometry) {
    const createBatch = (): CopyBatch => new CopyBatch(parent, paint(geometry.clone(), 1, 1, 1));
    this.batches = { opaqueBatch: createBatch(), translucentBatch: createBatch() };
  }

  begin(): void {
    this.copies.length = 0;
  }

  add(matrix: Matrix4, color: number, alpha: number): void {
    this.copies.push({ matrix, color, alpha });
  }

  end(): void {
    const { opaqueBatch, translucentBatch } = this.batches;
    opaqueBatch.begin(this.copies.length);
    translucentBatch.begin(this.copies.length);
    for (const { matrix, alpha, color } of this.copies) {
      if (alpha < MIN_OPAQUE_ALPHA) translucentBatch.add(matrix, 0, alpha, color);
      else opaqueBatch.add(matrix, 0, 1, color);
    }
    opaqueBatch.end();
    translucentBatch.end();
  }

  expandBox(box: Box3): void {
    this.batches.opaqueBatch.expandBox(box);
    this.batches.translucentBatch.expandBox(box);
  }

  dispose(): void {
    this.batches.opaqueBatch.dispose();
    this.batches.translucentBatch.dispose();
  }
}

interface Arrow {
  pose: Matrix4;
  shape: ArrowShape;
  color: number;
  alpha: number;
}

/** Markers made of cubes, spheres, cylinders and arrows, drawn in a few calls. */
export class SolidMarkers {
  private readonly solids: Record<"cube" | "sphere" | "cylinder", ShapeCopies>;
  private readonly opaqueArrows: ArrowBatch;
  private readonly translucentArrows: ArrowBatch;
  private readonly arrows: Arrow[] = [];

  constructor(parent: Object3D) {
    this.solids = {
      cube: new ShapeCopies(parent, unitBox),
      sphere: new ShapeCopies(parent, unitSphere),
      cylinder: new ShapeCopies(parent, unitCylinder),
    };
    this.opaqueArrows = new ArrowBatch(parent);
    this.translucentArrows = new ArrowBatch(parent);
  }

  begin(): void {
    for (const solids of Object.values(this.solids)) solids.begin();
    this.arrows.length = 0;
  }

  /** Adds a marker. `pose` is in the parent's frame; it is not copied, so it must not change. */
  add(marker: MarkerShape, pose: Matrix4): void {
    const { shape } = marker;
    if (shape === "arrow" || shape === "arrow_strip") this.arrows.push(...createArrows(marker, pose));
    else if (shape === "cube" || shape === "sphere" || shape === "cylinder") {
      this.solids[shape].add(scalePose(pose, marker), ...readColor(marker.color, 0));
    } else this.addList(marker, pose);
  }

  end(): void {
    for (const solids of Object.values(this.solids)) solids.end();
    const translucentArrows = this.arrows.filter((arrow) => arrow.alpha < MIN_OPAQUE_ALPHA);
    const opaqueArrows = this.arrows.filter((arrow) => arrow.alpha >= MIN_OPAQUE_ALPHA);
    for (const [batch, arrows] of [[this.opaqueArrows, opaqueArrows], [this.translucentArrows, translucentArrows]] as const) {
      batch.begin(arrows.length);
      for (const { pose, shape, color, alpha } of arrows) batch.add(pose, shape, { color, alpha });
      batch.end();
    }
  }

  expandBox(box: Box3): void {
    for (const solids of Object.values(this.solids)) solids.expandBox(box);
    this.opaqueArrows.expandBox(box);
    this.translucentArrows.expandBox(box);
  }

  dispose(): void {
    for (const solids of Object.values(this.solids)) solids.dispose();
    this.opaqueArrows.dispose();
    this.translucentArrows.dispose();
  }

  private addList(marker: MarkerShape, pose: Matrix4): void {
    const solids = this.solids[marker.shape === "cube_list" ? "cube" : "sphere"];
    const { points, colors, color } = marker;
    const hasOwnColors = colors.length / 4 === points.length / 3;
    const shape = scalePose(new Matrix4(), marker);
    const placement = new Matrix4();
    for (let i = 0; i < points.length / 3; i++) {
      placement.makeTranslation(points[i * 3] ?? 0, points[i * 3 + 1] ?? 0, points[i * 3 + 2] ?? 0);
      const matrix = new Matrix4().multiplyMatrices(pose, placement).multiply(shape);
      solids.add(matrix, ...(hasOwnColors ? readColor(colors, i * 4) : readColor(color, 0)));
    }
  }
}

/** Returns objects with the surfaces of a marker, for picking and outlining; they are not part of a scene. */
export function createMarkerSurfaces(marker: MarkerShape, pose: Matrix4): Mesh[] {
  const meshAt = (geometry: BufferGeometry, matrix: Matrix4): Mesh => {
    const mesh = new Mesh(geometry);
    mesh.matrixAutoUpdate = false;
    mesh.matrix.copy(matrix);
    mesh.matrixWorld.copy(matrix);
    return mesh;
  };
  if (marker.shape === "arrow" || marker.shape === "arrow_strip") {
    return createArrows(marker, pose).map(({ pose: matrix, shape }) => {
      const length = shape.shaftLength + shape.headLength;
      const width = Math.max(shape.shaftDiameter, shape.headDiameter);
      const box = new Matrix4().makeScale(length, width, width).setPosition(length / 2, 0, 0);
      return meshAt(unitBox, box.premultiply(matrix));
    });
  }
  const isList = marker.shape === "cube_list" || marker.shape === "sphere_list";
  const geometry = SHAPES[isList ? marker.shape.slice(0, -"_list".length) : marker.shape]?.geometry ?? unitBox;
  if (!isList) return [meshAt(geometry, scalePose(pose, marker))];
  const shape = scalePose(new Matrix4(), marker);
  const meshes: Mesh[] = [];
  for (let i = 0; i < marker.points.length; i += 3) {
    const [x = 0, y = 0, z = 0] = marker.points.subarray(i, i + 3);
    meshes.push(meshAt(geometry, new Matrix4().makeTranslation(x, y, z).premultiply(pose).multiply(shape)));
  }
  return meshes;
}

function scalePose(pose: Matrix4, marker: MarkerShape): Matrix4 {
  const name = marker.shape.replace("_list", "");
  const isHalved = SHAPES[name]?.isHalved ?? [false, false, false];
  const [x = 1, y = 1, z = 1] = marker.scale.map((size, axis) => (isHalved[axis] === true ? size / 2 : size));
  return pose.clone().multiply(new Matrix4().makeScale(x, y, z));
}

function readColor(colors: ArrayLike<number>, offset: number): [number, number] {
  const color = new Color(colors[offset] ?? 0, colors[offset + 1] ?? 0, colors[offset + 2] ?? 0);
  return [color.getHex(), colors[offset + 3] ?? 1];
}

function createArrows(marker: MarkerShape, pose: Matrix4): Arrow[] {
  const [color, alpha] = readColor(marker.color, 0);
  const { points, scale } = marker;
  if (marker.shape === "arrow" && points.length === 0) {
    const [x = 1, y = 1, z = 1] = scale;
    return [{ pose: pose.clone().multiply(new Matrix4().makeScale(x, y, z)), shape: DEFAULT_ARROW, color, alpha }];
  }
  const [shaftDiameter = 0, headDiameter = 0, requestedHeadLength = 0] = scale;
  const headShare = marker.shape === "arrow" ? HEAD_SHARE : STRIP_HEAD_SHARE;
  const arrows: Arrow[] = [];
  for (let i = 0; i + 5 < points.length; i += 3) {
    const start = new Vector3().fromArray(points, i);
    const direction = new Vector3().fromArray(points, i + 3).sub(start);
    const length = direction.length();
    const headLength = requestedHeadLength === 0 ? headShare * length : Math.max(0, Math.min(requestedHeadLength, length));
    const shape = { shaftLength: length - headLength, shaftDiameter, headLength, headDiameter };
    arrows.push({ pose: poseAlongX(start, direction, new Matrix4()).premultiply(pose), shape, color, alpha });
  }
  return arrows;
}
