import { Box3, Vector3, type Matrix4 } from "three";

/** Half the side of the room that is looked for, and how far places are from one another, m. */
const HALF = 0.5;
const STEP = 1;
/** What is no higher than this is a floor, m. */
const FLOOR = 0.05;
/** So many steps from the origin, nothing more is tried. */
const MOST = 20;
const SIDES = [[1, 0], [0, 1], [-1, 0], [0, -1]] as const;

/**
 * Where on the ground of a world there is room for a thing of a metre: its origin, or else the nearest whole metre on an
 * axis that is free; beside all that is there, where none is.
 *
 * @param boxes around what is there, in the fixed frame, m
 * @param world where the world is in the fixed frame
 */
export function freePlace(boxes: readonly Box3[], world: Matrix4): number[] {
  const isFree = (place: readonly number[]): boolean => {
    const [x, y, z] = new Vector3().fromArray(place).applyMatrix4(world).toArray();
    const room = new Box3(new Vector3(x - HALF, y - HALF, z + FLOOR), new Vector3(x + HALF, y + HALF, z + 2 * HALF));
    return !boxes.some((box) => box.intersectsBox(room));
  };
  const places = [[0, 0, 0]];
  for (let step = 1; step <= MOST; step++) for (const [x, y] of SIDES) places.push([x * step * STEP, y * step * STEP, 0]);
  const all = boxes.reduce((sum, box) => sum.union(box), new Box3()).applyMatrix4(world.clone().invert());
  return places.find(isFree) ?? [Math.ceil(all.max.x + HALF), 0, 0];
}
