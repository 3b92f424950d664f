/** The point nearest to the start of a ray. */
export interface NearestPoint {
  index: number;
  /** The distance along the ray, m. */
  distance: number;
}

/**
 * Returns the first point along a ray within `radius` m of it, or within `slope` times its distance, which is the area
 * that a pointer of some pixels covers. `origin` and `direction` (a unit vector) are in the frame of the points.
 */
export function findNearestPoint(
  positions: Float32Array,
  origin: readonly [number, number, number],
  direction: readonly [number, number, number],
  radius: number,
  slope: number,
): NearestPoint | null {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let nearestPoint: NearestPoint | null = null;
  let nearestDistance = Infinity;
  for (let i = 0; i < positions.length; i += 3) {
    const x = (positions[i] ?? 0) - ox;
    const y = (positions[i + 1] ?? 0) - oy;
    const z = (positions[i + 2] ?? 0) - oz;
    const distance = x * dx + y * dy + z * dz;
    if (distance <= 0 || distance >= nearestDistance) continue;
    const limit = radius + slope * distance;
    if (x * x + y * y + z * z - distance * distance > limit * limit) continue;
    nearestDistance = distance;
    nearestPoint = { index: i / 3, distance };
  }
  return nearestPoint;
}
