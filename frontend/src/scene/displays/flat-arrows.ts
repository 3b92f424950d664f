import { Matrix4, Vector3 } from "three";
import { poseAt } from "./styles";

/** An arrow of three lines, one meter long: start to tip, tip to one barb, tip to the other barb. */
const FLAT_ARROW = [
  [0, 0],
  [1, 0],
  [1, 0],
  [0.75, 0.2],
  [1, 0],
  [0.75, -0.2],
] as const;

/**
 * Returns line arrows at poses in a frame, as segments in the fixed frame; `lengthOf` returns each arrow's length, m.
 */
export function createFlatArrows(poses: Float32Array, frame: Matrix4, lengthOf: (pose: number) => number): Float32Array {
  const count = poses.length / 7;
  const segments = new Float32Array(count * FLAT_ARROW.length * 3);
  const [matrix, point] = [new Matrix4(), new Vector3()];
  for (let i = 0; i < count; i++) {
    poseAt(poses, i, matrix).premultiply(frame);
    const length = lengthOf(i);
    FLAT_ARROW.forEach(([x, y], pointIndex) => {
      point.set(x * length, y * length, 0).applyMatrix4(matrix);
      point.toArray(segments, (i * FLAT_ARROW.length + pointIndex) * 3);
    });
  }
  return segments;
}
