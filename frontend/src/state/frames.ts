import type { Transforms } from "../connection/transforms";
import type { FrameTable } from "../protocol";
import { Signal } from "../signal";

/** The position (m) and orientation of a frame in the fixed frame. */
export interface FramePose {
  position: [number, number, number];
  orientation: [number, number, number, number];
}

/** The numbers of a pose: x y z qx qy qz qw. */
const POSE_SIZE = 7;
const NO_NUMBERS = new Float32Array(0);

/** The newest pose of every frame. Rows are those of the frame table; a row of NaN has no transform. */
export class FrameStore {
  /** The names of frames or their parents changed. */
  readonly tableChanged = new Signal();
  /** At least one pose changed. */
  readonly posesChanged = new Signal();
  /** Only the ages changed. */
  readonly agesChanged = new Signal();
  names: readonly string[] = [];
  parents: readonly number[] = [];
  poses: Float32Array = NO_NUMBERS;
  ages: Float32Array = NO_NUMBERS;
  stamp = 0;
  /** The fixed frame, which may be unknown to tf. */
  fixedFrame = "";
  private revision = -1;
  private rows = new Map<string, number>();
  private pendingTransforms: Transforms | null = null;

  setTable(table: FrameTable): void {
    const previousRows = this.rows;
    const { poses, ages } = this;
    this.revision = table.revision;
    this.names = table.names;
    this.parents = table.parents;
    this.rows = new Map(table.names.map((name, row) => [name, row]));
    this.poses = new Float32Array(table.names.length * POSE_SIZE).fill(NaN);
    this.ages = new Float32Array(table.names.length);
    for (const [name, row] of this.rows) {
      const previousRow = previousRows.get(name);
      if (previousRow === undefined) continue;
      this.poses.set(poses.subarray(previousRow * POSE_SIZE, (previousRow + 1) * POSE_SIZE), row * POSE_SIZE);
      this.ages[row] = ages[previousRow] ?? 0;
    }
    this.tableChanged.emit();
    if (this.pendingTransforms?.revision === table.revision) this.apply(this.pendingTransforms);
    this.pendingTransforms = null;
  }

  /**
   * Sets the newest poses. Poses of a table that has not arrived yet are stored until it does; older ones are dropped.
   */
  setTransforms(transforms: Transforms): void {
    if (transforms.revision === this.revision) this.apply(transforms);
    else if (transforms.revision > this.revision) this.pendingTransforms = transforms;
  }

  /** Returns the row of a frame, or -1. */
  rowOf(name: string): number {
    return this.rows.get(name) ?? -1;
  }

  hasPose(row: number): boolean {
    return row >= 0 && !Number.isNaN(this.poses[row * POSE_SIZE] ?? NaN);
  }

  /** Returns the distance of two frames: the largest difference of their coordinates in m or quaternion components. */
  computeDifference(first: string, second: string): number {
    const [firstRow, secondRow] = [this.rowOf(first), this.rowOf(second)];
    if (!this.hasPose(firstRow) || !this.hasPose(secondRow)) return Infinity;
    let maximum = 0;
    for (let i = 0; i < POSE_SIZE; i++) {
      const difference = (this.poses[firstRow * POSE_SIZE + i] ?? 0) - (this.poses[secondRow * POSE_SIZE + i] ?? 0);
      maximum = Math.max(maximum, Math.abs(difference));
    }
    return maximum;
  }

  /** Returns all frames with a pose. */
  snapshot(): Record<string, FramePose> {
    const framePoses: Record<string, FramePose> = {};
    this.names.forEach((name, row) => {
      if (!this.hasPose(row)) return;
      const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = this.poses.subarray(row * POSE_SIZE, (row + 1) * POSE_SIZE);
      framePoses[name] = { position: [x, y, z], orientation: [qx, qy, qz, qw] };
    });
    return framePoses;
  }

  private apply(transforms: Transforms): void {
    if (transforms.poses.length !== this.poses.length) return;
    const hasChanged = !hasSameNumbers(this.poses, transforms.poses);
    this.poses = transforms.poses;
    this.ages = transforms.ages;
    this.stamp = transforms.stamp;
    if (hasChanged) this.posesChanged.emit();
    else this.agesChanged.emit();
  }
}

function hasSameNumbers(a: Float32Array, b: Float32Array): boolean {
  for (let i = 0; i < a.length; i++) if (!Object.is(a[i], b[i])) return false;
  return true;
}
