import { Box3, Vector3, type Matrix4 } from "three";

/** Half the side of the free space, and the distance between the positions that are tried, m. */
const HALF_SIDE_M = 0.5;
const STEP_M = 1;
/** Objects up to this height count as floor, m. */
const FLOOR_HEIGHT_M = 0.05;
/** The maximum number of steps in each direction. */
const MAX_STEPS = 20;
const DIRECTIONS = [[1, 0], [0, 1], [-1, 0], [0, -1]] as const;

/**
 * Returns a position on the ground of a world with room for an object of one meter: the given one or, along an axis,
 * the nearest free one at an integer number of meters from it; next to all existing objects if none of these is free.
 *
 * @param boxes - the boxes around the existing objects, in the fixed frame, m.
 * @param world - the pose of the world in the fixed frame.
 * @param center - the center of the robots, in the fixed frame, m; null for the origin of the world.
 */
export function findFreePosition(boxes: readonly Box3[], world: Matrix4, center: Vector3 | null = null): number[] {
  const toWorld = world.clone().invert();
  const { x: startX, y: startY } = center === null ? new Vector3() : center.clone().applyMatrix4(toWorld).round();
  const isFree = (position: readonly number[]): boolean => {
    const [x, y, z] = new Vector3().fromArray(position).applyMatrix4(world).toArray();
    const freeBox = new Box3(new Vector3(x - HALF_SIDE_M, y - HALF_SIDE_M, z + FLOOR_HEIGHT_M), new Vector3(x + HALF_SIDE_M, y + HALF_SIDE_M, z + 2 * HALF_SIDE_M));
    return !boxes.some((box) => box.intersectsBox(freeBox));
  };
  const candidates = [[startX, startY, 0]];
  for (let step = 1; step <= MAX_STEPS; step++) for (const [x, y] of DIRECTIONS) candidates.push([startX + x * step * STEP_M, startY + y * step * STEP_M, 0]);
  const bounds = boxes.reduce((union, box) => union.union(box), new Box3()).applyMatrix4(toWorld);
  return candidates.find(isFree) ?? [Math.ceil(bounds.max.x + HALF_SIDE_M), 0, 0];
}
