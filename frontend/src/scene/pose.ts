import { Quaternion, Vector3, type Matrix4 } from "three";
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
