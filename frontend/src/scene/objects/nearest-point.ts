/** The point nearest to the start of a ray. */
export interface NearPoint {
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
): NearPoint | null {
  const [ox, oy, oz] = origin;
  const [dx, dy, dz] = direction;
  let bestPoint: NearPoint | null = null;
  let bestDistance = Infinity;
  for (let i = 0; i < positions.length; i += 3) {
    const x = (positions[i] ?? 0) - ox;
    const y = (positions[i + 1] ?? 0) - oy;
    const z = (positions[i + 2] ?? 0) - oz;
    const distance = x * dx + y * dy + z * dz;
    if (distance <= 0 || distance >= bestDistance) continue;
    const limit = radius + slope * distance;
    if (x * x + y * y + z * z - distance * distance > limit * limit) continue;
    bestDistance = distance;
    bestPoint = { index: i / 3, distance };
  }
  return bestPoint;
}
