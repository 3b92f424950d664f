import { Euler, Matrix4, Quaternion, Vector3 } from "three";
import { roundNoise } from "../../state/modeling/shapes";

const ONE = new Vector3(1, 1, 1);

/**
 * Returns the matrix of a pose as SDF writes it: x y z in m, and roll pitch yaw in rad about the fixed axes x, then y,
 * then z.
 */
export function createEntityMatrix(pose: readonly number[]): Matrix4 {
  const [x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0] = pose;
  const rotation = new Quaternion().setFromEuler(new Euler(roll, pitch, yaw, "ZYX"));
  return new Matrix4().compose(new Vector3(x, y, z), rotation, ONE);
}

/** Returns the pose of a matrix without scale. */
export function readEntityPose(matrix: Matrix4): number[] {
  const position = new Vector3().setFromMatrixPosition(matrix);
  const rotation = new Euler().setFromRotationMatrix(matrix, "ZYX");
  return [position.x, position.y, position.z, rotation.x, rotation.y, rotation.z].map(roundNoise);
}
