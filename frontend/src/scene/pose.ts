import { Quaternion, Vector3, type Matrix4 } from "three";
import type { DisplayData } from "../connection/data";
import type { FrameStore } from "../state/frames";

const position = new Vector3();
const orientation = new Quaternion();
const ONE = new Vector3(1, 1, 1);

/** Writes the pose of a frame into `matrix`; false, and nothing written, where the frame has no transform. */
export function framePose(frames: FrameStore, row: number, matrix: Matrix4): boolean {
  if (!frames.has(row)) return false;
  position.fromArray(frames.poses, row * 7);
  orientation.fromArray(frames.poses, row * 7 + 3);
  matrix.compose(position, orientation, ONE);
  return true;
}

/**
 * Writes the pose of a display's content into `matrix`: where its frame was then, or is now if it follows its frame.
 * False, and nothing written, where the frame has no transform.
 */
export function dataPose(frames: FrameStore, data: DisplayData, matrix: Matrix4): boolean {
  if (data.pose) {
    position.fromArray(data.pose, 0);
    orientation.fromArray(data.pose, 3);
    matrix.compose(position, orientation, ONE);
    return true;
  }
  if (data.frame !== "" && data.frame !== frames.fixedFrame) return framePose(frames, frames.row(data.frame), matrix);
  matrix.identity();
  return true;
}
