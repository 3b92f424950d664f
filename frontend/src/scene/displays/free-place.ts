import { Box3, Vector3, type Matrix4 } from "three";

/** Half the side of the room that is looked for, and how far places are from one another, m. */
const HALF = 0.5;
const STEP = 1;
/** A thing of at most this height is a floor, m. */
const FLOOR = 0.05;
/** So many steps from the origin, nothing more is tried. */
const MOST = 20;
const SIDES = [[1, 0], [0, 1], [-1, 0], [0, -1]] as const;

/**
 * Where on the ground of a world there is room for a thing of a metre: at a place, or else the nearest whole metre from
 * it, along an axis, that is free; beside all existing things if no place is free.
 *
 * @param boxes around the existing things, in the fixed frame, m
 * @param world where the world is in the fixed frame
 * @param near the middle of the robots, in the fixed frame, m; null for the origin of the world
 */
export function freePlace(boxes: readonly Box3[], world: Matrix4, near: Vector3 | null = null): number[] {
  const toWorld = world.clone().invert();
  const { x: atX, y: atY } = near === null ? new Vector3() : near.clone().applyMatrix4(toWorld).round();
  const isFree = (place: readonly number[]): boolean => {
    const [x, y, z] = new Vector3().fromArray(place).applyMatrix4(world).toArray();
    const room = new Box3(new Vector3(x - HALF, y - HALF, z + FLOOR), new Vector3(x + HALF, y + HALF, z + 2 * HALF));
    return !boxes.some((box) => box.intersectsBox(room));
  };
  const places = [[atX, atY, 0]];
  for (let step = 1; step <= MOST; step++) for (const [x, y] of SIDES) places.push([atX + x * step * STEP, atY + y * step * STEP, 0]);
  const all = boxes.reduce((sum, box) => sum.union(box), new Box3()).applyMatrix4(toWorld);
  return places.find(isFree) ?? [Math.ceil(all.max.x + HALF), 0, 0];
}
