import { Matrix4, Quaternion, Vector3, type Box3, type Object3D } from "three";
import { CopyBatch } from "./copy-batch";
import { computePrincipalAxes } from "./eigen";
import { createSphere, createCylinder, createCone } from "./geometries";

/** RViz's CovarianceProperty; null for a part that is not drawn. Colors as 0xrrggbb. */
export interface CovarianceStyle {
  position: { color: number; alpha: number; scale: number } | null;
  orientation: {
    /** Whether deviations are about the axes of the pose instead of those of its frame. */
    isLocal: boolean;
    /** The colors of the rotations about x, y and z. */
    colors: readonly [number, number, number];
    alpha: number;
    offset: number;
    scale: number;
  } | null;
}

/** The thickness of flat shapes, m. */
const FLAT_THICKNESS_M = 0.001;
/** Larger angles are clamped to this, because they look alike. */
const MAX_ANGLE_RAD = (89 * Math.PI) / 180;
const SEGMENT_COUNT = 24;

/**
 * The covariances of poses in three draw calls: an ellipsoid for the position and, for the orientation, a disc on each
 * axis that shows its possible tilt. A planar pose (no deviation in z, roll and pitch) has an ellipse, and a triangle
 * that shows its possible rotation. All of it is drawn as by RViz's CovarianceVisual.
 */
export class CovarianceBatch {
  private readonly spheres: CopyBatch;
  private readonly discs: CopyBatch;
  private readonly cones: CopyBatch;
  private readonly matrix = new Matrix4();
  private readonly scale = new Matrix4();
  private readonly root = new Matrix4();

  constructor(parent: Object3D) {
    this.spheres = new CopyBatch(parent, createSphere(SEGMENT_COUNT));
    this.discs = new CopyBatch(parent, createCylinder(SEGMENT_COUNT));
    this.cones = new CopyBatch(parent, createCone(SEGMENT_COUNT));
  }

  /** Removes all covariances; at most `capacity` poses will be added. */
  begin(capacity: number): void {
    this.spheres.begin(capacity);
    this.discs.begin(capacity * 3);
    this.cones.begin(capacity);
  }

  /**
   * Adds the covariance of a pose.
   *
   * @param frame - the pose of the frame in which `pose` is given.
   * @param pose - x, y, z, qx, qy, qz, qw in that frame.
   * @param covariance - 36 numbers, row by row over x, y, z and the rotations about them.
   */
  add(frame: Matrix4, pose: Float32Array, covariance: Float32Array, style: CovarianceStyle): void {
    const covarianceAt = (row: number, column: number): number => covariance[row * 6 + column] ?? 0;
    const isInPlane = covarianceAt(2, 2) <= 0 && covarianceAt(3, 3) <= 0 && covarianceAt(4, 4) <= 0;
    const position = new Vector3().fromArray(pose);
    if (style.position) {
      const { color, alpha, scale } = style.position;
      this.root.makeTranslation(position).premultiply(frame);
      const shape = isInPlane
        ? computeDeviations([covarianceAt(0, 0), covarianceAt(0, 1), 0, covarianceAt(1, 0), covarianceAt(1, 1), 0, 0, 0, 0])
        : computeDeviations([
            covarianceAt(0, 0), covarianceAt(0, 1), covarianceAt(0, 2),
            covarianceAt(1, 0), covarianceAt(1, 1), covarianceAt(1, 2),
            covarianceAt(2, 0), covarianceAt(2, 1), covarianceAt(2, 2),
          ]);
      if (shape) {
        const [x, y, z] = shape.deviations.map((deviation) => 2 * deviation * scale) as [number, number, number];
        const size = this.scale.makeScale(clampToFlat(x), clampToFlat(y), clampToFlat(z));
        this.spheres.add(this.matrix.copy(this.root).multiply(shape.axes).multiply(size), 0, alpha, color);
      }
    }
    if (!style.orientation) return;
    this.root.makeTranslation(position);
    if (style.orientation.isLocal) {
      this.root.multiply(new Matrix4().makeRotationFromQuaternion(new Quaternion().fromArray(pose, 3).normalize()));
    }
    this.root.premultiply(frame);
    if (isInPlane) this.addTriangle(covarianceAt(5, 5), style.orientation);
    else this.addDiscs(covarianceAt, style.orientation);
  }

  end(): void {
    for (const batch of [this.spheres, this.discs, this.cones]) batch.end();
  }

  expandBox(box: Box3): void {
    for (const batch of [this.spheres, this.discs, this.cones]) batch.expandBox(box);
  }

  dispose(): void {
    for (const batch of [this.spheres, this.discs, this.cones]) batch.dispose();
  }

  /** Adds a triangle with its tip at the pose and its base at `offset` along x. */
  private addTriangle(variance: number, style: NonNullable<CovarianceStyle["orientation"]>): void {
    const { offset, scale, alpha, colors } = style;
    if (!(variance >= 0) || offset <= 0) return;
    const width = offset * computeAngleWidth(2 * Math.sqrt(variance) * scale);
    // The batch's cone has its base at the origin and its tip along x: turn it around.
    this.matrix.makeTranslation(offset, 0, 0).premultiply(this.root);
    this.cones.add(this.matrix.multiply(this.scale.makeScale(-offset, -clampToFlat(width), FLAT_THICKNESS_M)), 0, alpha, colors[2]);
  }

  private addDiscs(
    covarianceAt: (row: number, column: number) => number,
    style: NonNullable<CovarianceStyle["orientation"]>,
  ): void {
    const { offset, scale, alpha, colors } = style;
    for (const axis of [0, 1, 2]) {
      const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
      const shape = computeDeviations([covarianceAt(3 + u, 3 + u), covarianceAt(3 + u, 3 + v), 0, covarianceAt(3 + v, 3 + u), covarianceAt(3 + v, 3 + v), 0, 0, 0, 0]);
      if (!shape || offset <= 0) continue;
      const [x, y] = shape.deviations.map((deviation) => clampToFlat(offset * computeAngleWidth(2 * deviation * scale)));
      this.matrix.copy(this.root).multiply(DISC_ORIENTATIONS[axis] ?? DISC_ORIENTATIONS[2]).multiply(this.scale.makeTranslation(0, 0, offset));
      this.matrix.multiply(shape.axes).multiply(this.scale.makeScale(x ?? FLAT_THICKNESS_M, y ?? FLAT_THICKNESS_M, FLAT_THICKNESS_M));
      this.discs.add(this.matrix, 0, alpha, colors[axis] ?? colors[2]);
    }
  }
}

/**
 * For each axis: z is that axis, and x and y are the directions in which rotations about the two following axes move
 * it. For the z axis, RViz swaps these two.
 */
const DISC_ORIENTATIONS = [
  new Matrix4().makeBasis(new Vector3(0, 0, 1), new Vector3(0, -1, 0), new Vector3(1, 0, 0)),
  new Matrix4().makeBasis(new Vector3(1, 0, 0), new Vector3(0, 0, -1), new Vector3(0, 1, 0)),
  new Matrix4().makeBasis(new Vector3(0, -1, 0), new Vector3(1, 0, 0), new Vector3(0, 0, 1)),
] as const;

type Matrix3Rows = Parameters<typeof computePrincipalAxes>[0];

/**
 * Returns standard deviations and their axes; null for rows that are not a covariance, which RViz does not draw either.
 */
function computeDeviations(rows: Matrix3Rows): { deviations: number[]; axes: Matrix4 } | null {
  const { values, axes } = computePrincipalAxes(rows);
  const maximum = Math.max(...values.map(Math.abs));
  if (!Number.isFinite(maximum) || values.some((value) => value < -1e-6 * maximum)) return null;
  return { deviations: values.map((value) => Math.sqrt(Math.max(0, value))), axes };
}

/** Returns the width of an angle at a distance of one meter. */
function computeAngleWidth(radians: number): number {
  return 2 * Math.tan(Math.min(radians / 2, MAX_ANGLE_RAD));
}

function clampToFlat(size: number): number {
  return Math.max(size, FLAT_THICKNESS_M);
}
