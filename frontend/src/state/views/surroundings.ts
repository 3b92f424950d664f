import { add, scale, subtract, turn, type Span, type Vector } from "./vector";
import { direction, OrbitController } from "./orbit";
import { number, wrapYaw, type ViewValues } from "./view-controller";
import type { ViewSize } from "./camera";

/** Room around a robot in a world: so many times its size, and at least so many metres. */
const ROOM = 0.75;
/** From where a robot is seen, and a world without robots, rad above the horizon. */
const ROBOT_PITCH = 0.5;
const OVERVIEW_PITCH = 0.785398;
/** The viewpoints to try if an object hides the robot, or much around it: higher up, from other sides, nearer. */
const PITCHES = [0, 0.3, 0.6, 0.9];
const SIDES = [0, -Math.PI / 2, Math.PI / 2, Math.PI];
const NEARER = [1, 0.6, 0.35];
/** So much of the surroundings must be seen more for a step higher up, or to another side. */
const HIGHER = 0.15;
const ASIDE = 0.05;
/** Places around a robot. */
const PLACES = 8;
/** The directions that are tried, and the most that each can score. */
const DIRECTIONS = PITCHES.flatMap((pitch, higher) =>
  SIDES.map((side, aside) => ({ pitch, side, most: 1 - higher * HIGHER - aside * ASIDE })),
);
const orbit = new OrbitController();

/** Whether nothing hides a place from a viewpoint. */
export type IsSeen = (viewpoint: Vector, place: Vector) => boolean;

/** The values of an Orbit that shows all of a world from above. */
export function overview(values: ViewValues, world: Span, size: ViewSize): ViewValues {
  const from = { ...values, Pitch: OVERVIEW_PITCH };
  return { Pitch: OVERVIEW_PITCH, ...orbit.fit(from, world, size) };
}

/** The values of an Orbit that shows a robot and its surroundings, from where most of both is visible. */
export function around(values: ViewValues, { min, max }: Span, size: ViewSize, isSeen: IsSeen): ViewValues {
  const span = Math.max(...subtract(max, min));
  const room = Math.max(ROOM, ROOM * span);
  const middle = scale(add(min, max), 0.5);
  const top: Vector = [middle[0], middle[1], max[2]];
  const ring = Array.from({ length: PLACES }, (_, i) => add(middle, turn([1, 0, 0], (i * 2 * Math.PI) / PLACES), span / 2 + room));
  const all = orbit.fit({ ...values, Pitch: ROBOT_PITCH }, { min: add(min, [1, 1, 1], -room), max: add(max, [1, 1, 1], room) }, size);
  const far = number(all, "Distance", 0);
  const covered = (viewpoint: Vector): number => ring.filter((place) => !isSeen(viewpoint, place)).length / PLACES;
  for (const nearer of NEARER) {
    let best: { score: number; values: ViewValues } | null = null;
    for (const { most, pitch, side } of DIRECTIONS) {
      if (best && most <= best.score) continue;
      const Yaw = wrapYaw(number(values, "Yaw", 0) + side);
      const Pitch = ROBOT_PITCH + pitch;
      const viewpoint = add(middle, direction(Yaw, Pitch), nearer * far);
      if (!isSeen(viewpoint, middle) || !isSeen(viewpoint, top)) continue;
      const score = most - covered(viewpoint);
      if (!best || score > best.score) best = { score, values: { ...all, Yaw, Pitch, Distance: nearer * far } };
    }
    if (best) return best.values;
  }
  return all;
}
