import { Vector3, type BufferGeometry, type Camera, type Matrix4, type Object3D } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { paint, smallSphere, unitBox, unitCone, unitCylinder, unitPlane, unitSphere } from "../objects/geometries";

const GEOMETRIES = { box: unitBox, cylinder: unitCylinder, cone: unitCone, sphere: unitSphere, plane: unitPlane } as const;

const position = new Vector3();

/** A kind of shape; all shapes of a kind are drawn in one call. */
export type SolidKind = keyof typeof GEOMETRIES;

/** Returns the kind of batch for a shape; null for shapes that are drawn individually. */
export function solidKindOf(kind: string): SolidKind | null {
  if (kind === "ellipsoid") return "sphere";
  return kind in GEOMETRIES ? (kind as SolidKind) : null;
}

/** Up to this share of the height of the image, a sphere looks round with few vertices. */
const MAX_SMALL_SHARE = 0.06;

/** A sphere to draw, as the matrix that maps the unit sphere to it. */
interface SphereCopy {
  readonly matrix: Matrix4;
  readonly color: number;
  isSmall: boolean;
}

/**
 * Draws opaque boxes, cylinders, cones, spheres and planes. Call `begin`, `add` and `end` as with `CopyBatch`, and
 * `chooseDetail` before each frame. Spheres have ten times the vertices of the others, which without a GPU took two
 * fifths of the time of a frame: those that look small are drawn with fewer.
 */
export class Solids {
  private readonly batches: ReadonlyMap<SolidKind, CopyBatch>;
  private readonly smallBatch: CopyBatch;
  private spheres: SphereCopy[] = [];
  private isStale = false;
  private readonly softness = { value: false };

  constructor(parent: Object3D) {
    const kinds = Object.keys(GEOMETRIES) as SolidKind[];
    const createBatch = (shape: BufferGeometry, isBehind = false): CopyBatch => {
      return new CopyBatch(parent, paint(shape.clone(), 1, 1, 1), { isBehind, isSoft: this.softness });
    };
    this.batches = new Map(kinds.map((kind) => [kind, createBatch(GEOMETRIES[kind], kind === "plane")]));
    this.smallBatch = createBatch(smallSphere);
  }

  /** Whether the solids have the soft light instead of RViz's. */
  set isSoft(isSoft: boolean) {
    this.softness.value = isSoft;
  }

  /** The number of solids drawn. */
  get size(): number {
    let sum = this.spheres.length;
    for (const [kind, batch] of this.batches) if (kind !== "sphere") sum += batch.size;
    return sum;
  }

  /** The number of spheres drawn with few vertices. */
  get smallSphereCount(): number {
    return this.smallBatch.size;
  }

  /** Removes all solids; at most this many of each kind will be added. */
  begin(counts: ReadonlyMap<SolidKind, number>): void {
    for (const [kind, batch] of this.batches) if (kind !== "sphere") batch.begin(counts.get(kind) ?? 0);
    this.spheres = [];
  }

  /** Adds a solid. `matrix` is in the parent's frame and applies to the unit shape; `color` is 0xrrggbb. */
  add(kind: SolidKind, matrix: Matrix4, color: number): void {
    if (kind === "sphere") this.spheres.push({ matrix: matrix.clone(), color, isSmall: false });
    else this.batches.get(kind)?.add(matrix, 0, 1, color);
  }

  end(): void {
    for (const [kind, batch] of this.batches) if (kind !== "sphere") batch.end();
    this.isStale = true;
  }

  /** Chooses the detail of the spheres for a camera in the parent's frame. */
  chooseDetail(camera: Camera): void {
    let hasChanged = this.isStale;
    for (const sphere of this.spheres) {
      const isSmall = computeImageShare(sphere.matrix, camera) < MAX_SMALL_SHARE;
      hasChanged ||= isSmall !== sphere.isSmall;
      sphere.isSmall = isSmall;
    }
    this.isStale = false;
    if (hasChanged) this.fillSphereBatches();
  }

  dispose(): void {
    for (const batch of [...this.batches.values(), this.smallBatch]) batch.dispose();
  }

  private fillSphereBatches(): void {
    const smallSpheres = this.spheres.filter((sphere) => sphere.isSmall);
    const largeSpheres = this.spheres.filter((sphere) => !sphere.isSmall);
    for (const [batch, spheres] of [[this.smallBatch, smallSpheres], [this.batches.get("sphere"), largeSpheres]] as const) {
      batch?.begin(spheres.length);
      for (const { matrix, color } of spheres) batch?.add(matrix, 0, 1, color);
      batch?.end();
    }
  }
}

/**
 * Returns the radius of a sphere in an image as a share of the image's height; infinite if the camera is inside it or
 * level with it.
 */
function computeImageShare(matrix: Matrix4, camera: Camera): number {
  const radius = matrix.getMaxScaleOnAxis();
  const { elements } = camera.projectionMatrix;
  const depth = -position.setFromMatrixPosition(matrix).applyMatrix4(camera.matrixWorldInverse).z;
  const isPerspective = elements[11] !== 0;
  if (isPerspective && Math.abs(depth) <= radius) return Infinity;
  return (radius * elements[5]) / 2 / (isPerspective ? Math.abs(depth) : 1);
}
