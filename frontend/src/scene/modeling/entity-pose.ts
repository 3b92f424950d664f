import { Euler, Matrix4, Quaternion, Vector3 } from "three";
import { roundNoise } from "../../state/modeling/shapes";

const ONE = new Vector3(1, 1, 1);

/**
 * Returns the matrix of a pose as SDF writes it: x y z in m, and roll pitch yaw in rad about the fixed axes x, then y,
 * then z.
 */
export function entityMatrix(pose: readonly number[]): Matrix4 {
  const [x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0] = pose;
  const turn = new Quaternion().setFromEuler(new Euler(roll, pitch, yaw, "ZYX"));
  return new Matrix4().compose(new Vector3(x, y, z), turn, ONE);
}

/** Returns the pose of a matrix without scale. */
export function entityPose(matrix: Matrix4): number[] {
  const at = new Vector3().setFromMatrixPosition(matrix);
  const turn = new Euler().setFromRotationMatrix(matrix, "ZYX");
  return [at.x, at.y, at.z, turn.x, turn.y, turn.z].map(roundNoise);
}
