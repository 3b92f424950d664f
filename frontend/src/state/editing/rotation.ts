/** The components x, y, z, w. */
export type Quaternion = readonly [number, number, number, number];

/** Below this, the cosine of pitch counts as 0, and only the sum or difference of roll and yaw matters. */
const GIMBAL_LOCK_COSINE = 1e-7;

/** Returns the rotation of roll, pitch and yaw (rad) about the fixed axes, as in URDF. */
export function quaternionOf([roll = 0, pitch = 0, yaw = 0]: readonly number[]): Quaternion {
  const [sr, cr] = [Math.sin(roll / 2), Math.cos(roll / 2)];
  const [sp, cp] = [Math.sin(pitch / 2), Math.cos(pitch / 2)];
  const [sy, cy] = [Math.sin(yaw / 2), Math.cos(yaw / 2)];
  return [sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy];
}

/** Returns roll, pitch and yaw of a rotation: of all equivalent values, those closest to `reference`. */
export function findNearestRpy([x, y, z, w]: Quaternion, reference: readonly number[]): [number, number, number] {
  const [nearRoll = 0, nearPitch = 0, nearYaw = 0] = reference;
  const cosPitchCosYaw = 1 - 2 * (y * y + z * z);
  const cosPitchSinYaw = 2 * (x * y + z * w);
  const cosPitch = Math.hypot(cosPitchCosYaw, cosPitchSinYaw);
  const pitch = Math.atan2(-2 * (x * z - y * w), cosPitch);
  if (cosPitch < GIMBAL_LOCK_COSINE) {
    const yaw = Math.atan2(-2 * (x * y - z * w), 1 - 2 * (x * x + z * z));
    return [nearRoll, findNearestAngle(pitch, nearPitch), findNearestAngle(pitch > 0 ? yaw + nearRoll : yaw - nearRoll, nearYaw)];
  }
  const roll = Math.atan2(2 * (y * z + x * w), 1 - 2 * (x * x + y * y));
  const yaw = Math.atan2(cosPitchSinYaw, cosPitchCosYaw);
  const findNearestAngles = (rpy: readonly [number, number, number]): [number, number, number] => {
    return [findNearestAngle(rpy[0], nearRoll), findNearestAngle(rpy[1], nearPitch), findNearestAngle(rpy[2], nearYaw)];
  };
  const solution = findNearestAngles([roll, pitch, yaw]);
  const flippedSolution = findNearestAngles([roll + Math.PI, Math.PI - pitch, yaw + Math.PI]);
  const computeDistance = (rpy: readonly number[]): number => rpy.reduce((sum, angle, i) => sum + Math.abs(angle - (reference[i] ?? 0)), 0);
  return computeDistance(flippedSolution) < computeDistance(solution) - 1e-9 ? flippedSolution : solution;
}

/** Returns the equivalent angle within half a turn of another. */
function findNearestAngle(angle: number, reference: number): number {
  const difference = angle - reference;
  return reference + Math.atan2(Math.sin(difference), Math.cos(difference));
}
