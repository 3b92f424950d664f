import { Quaternion, Vector3, type Matrix4 } from "three";
import type { DisplayData } from "../connection/data";
import type { FrameStore } from "../state/frames";

const position = new Vector3();
const orientation = new Quaternion();
const ONE = new Vector3(1, 1, 1);

/** Computes the matrix of a pose, x y z (m) qx qy qz qw, from index `offset` on. */
export function setPoseMatrix(values: ArrayLike<number>, matrix: Matrix4, offset = 0): Matrix4 {
  position.fromArray(values, offset);
  orientation.fromArray(values, offset + 3);
  return matrix.compose(position, orientation, ONE);
}

/** Computes the pose of a frame; returns false, and leaves `matrix` unchanged, if the frame has no transform. */
export function readFramePose(frames: FrameStore, row: number, matrix: Matrix4): boolean {
  if (!frames.hasPose(row)) return false;
  setPoseMatrix(frames.poses, matrix, row * 7);
  return true;
}

/**
 * Computes the pose of a display's content: that of its frame at the time of the content, or now if the content follows
 * its frame. Returns false, and leaves `matrix` unchanged, if the frame has no transform.
 */
export function readDataPose(frames: FrameStore, data: DisplayData, matrix: Matrix4): boolean {
  if (data.pose) {
    setPoseMatrix(data.pose, matrix);
    return true;
  }
  if (data.frame !== "" && data.frame !== frames.fixedFrame) return readFramePose(frames, frames.rowOf(data.frame), matrix);
  matrix.identity();
  return true;
}
