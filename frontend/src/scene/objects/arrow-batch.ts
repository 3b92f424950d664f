import { Matrix4, Quaternion, Vector3, type Box3, type Object3D, type Raycaster } from "three";
import { CopyBatch, type CopyHit } from "./copy-batch";
import { createCone, createRod } from "./geometries";

/** RViz's arrow: a shaft followed by a head; lengths in m. */
export interface ArrowShape {
  shaftLength: number;
  shaftDiameter: number;
  headLength: number;
  headDiameter: number;
}

/** Colors as 0xrrggbb; the head has the shaft's color unless `headColor` is given. */
export interface ArrowLook {
  color: number;
  headColor?: number;
  alpha?: number;
  /** 0: its own color, 1: gray. */
  gray?: number;
}

const X_AXIS = new Vector3(1, 0, 0);
const ONE = new Vector3(1, 1, 1);

/** Any number of arrows in two draw calls, along the x axis of their poses, as in RViz. */
export class ArrowBatch {
  private readonly shafts: CopyBatch;
  private readonly heads: CopyBatch;
  /** The indices of the arrows that have a shaft. */
  private arrowsWithShaft: number[] = [];
  private readonly matrix = new Matrix4();
  private readonly partMatrix = new Matrix4();

  constructor(parent: Object3D, segments = 20) {
    this.shafts = new CopyBatch(parent, createRod(segments, "origin"));
    this.heads = new CopyBatch(parent, createCone(segments));
  }

  /** The number of arrows drawn now. */
  get size(): number {
    return this.heads.size;
  }

  /** Removes all arrows; at most `capacity` will be added. */
  begin(capacity: number): void {
    this.arrowsWithShaft = [];
    this.shafts.begin(capacity);
    this.heads.begin(capacity);
  }

  /** Adds an arrow from the origin of `pose` along its x axis. */
  add(pose: Matrix4, shape: ArrowShape, look: ArrowLook): void {
    const { shaftLength, shaftDiameter, headLength, headDiameter } = shape;
    const { color, headColor = color, alpha = 1, gray = 0 } = look;
    if (shaftLength > 0) {
      this.arrowsWithShaft.push(this.size);
      this.partMatrix.makeScale(shaftLength, shaftDiameter, shaftDiameter);
      this.shafts.add(this.matrix.multiplyMatrices(pose, this.partMatrix), gray, alpha, color);
    }
    this.partMatrix.makeScale(headLength, headDiameter, headDiameter).setPosition(shaftLength, 0, 0);
    this.heads.add(this.matrix.multiplyMatrices(pose, this.partMatrix), gray, alpha, headColor);
  }

  end(): void {
    this.shafts.end();
    this.heads.end();
  }

  expandBox(box: Box3): void {
    this.shafts.expandBox(box);
    this.heads.expandBox(box);
  }

  /** Returns the nearest arrow that a ray hits. */
  pick(ray: Raycaster): CopyHit | null {
    const [shaft, head] = [this.shafts.pick(ray), this.heads.pick(ray)];
    if (!shaft || (head && head.distance <= shaft.distance)) return head;
    return { ...shaft, copy: this.arrowsWithShaft[shaft.copy] ?? 0 };
  }

  dispose(): void {
    this.shafts.dispose();
    this.heads.dispose();
  }
}

const rotation = new Quaternion();
const unitDirection = new Vector3();

/** Computes a pose at `origin` whose x axis points along `direction`, which may have any length. */
export function poseAlongX(origin: Vector3, direction: Vector3, pose: Matrix4): Matrix4 {
  rotation.setFromUnitVectors(X_AXIS, unitDirection.copy(direction).normalize());
  return pose.compose(origin, rotation, ONE);
}
