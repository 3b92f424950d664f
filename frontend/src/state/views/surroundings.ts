import { add, scale, subtract, rotateZ, type Span, type Vector } from "./vector";
import { computeOrbitDirection, OrbitController } from "./orbit";
import { number, wrapYaw, type ViewValues } from "./view-controller";
import type { ViewSize } from "./camera";

/** The margin around a robot in a world: a factor of its size, and its minimum in m. */
const ROOM = 0.75;
/** The pitch from which a robot, and a world without robots, is viewed, rad above the horizon. */
const ROBOT_PITCH = 0.5;
const OVERVIEW_PITCH = 0.785398;
/** The changes of pitch, yaw and distance to try if objects hide the robot or its surroundings. */
const PITCHES = [0, 0.3, 0.6, 0.9];
const SIDES = [0, -Math.PI / 2, Math.PI / 2, Math.PI];
const NEARER = [1, 0.6, 0.35];
/** The share of the surroundings that must become visible to justify a step up, or to another side. */
const STEP_UP_COST = 0.15;
const SIDE_COST = 0.05;
/** The number of places around a robot whose visibility counts. */
const RING_POINTS = 8;
/** The directions to try, with the maximum score of each. */
const DIRECTIONS = PITCHES.flatMap((pitch, higher) =>
  SIDES.map((side, aside) => ({ pitch, side, most: 1 - higher * STEP_UP_COST - aside * SIDE_COST })),
);
const orbit = new OrbitController();

/** Returns whether nothing hides a place from a viewpoint. */
export type IsVisible = (viewpoint: Vector, position: Vector) => boolean;

/** Returns the values of an Orbit view of a whole world from above. */
export function computeOverview(values: ViewValues, world: Span, size: ViewSize): ViewValues {
  const startValues = { ...values, Pitch: OVERVIEW_PITCH };
  return { Pitch: OVERVIEW_PITCH, ...orbit.fit(startValues, world, size) };
}

/** Returns the values of an Orbit view of a robot and its surroundings, from where most of both is visible. */
export function computeViewAround(values: ViewValues, { min, max }: Span, size: ViewSize, isSeen: IsVisible): ViewValues {
  const span = Math.max(...subtract(max, min));
  const room = Math.max(ROOM, ROOM * span);
  const center = scale(add(min, max), 0.5);
  const top: Vector = [center[0], center[1], max[2]];
  const ring = Array.from({ length: RING_POINTS }, (_, i) => add(center, rotateZ([1, 0, 0], (i * 2 * Math.PI) / RING_POINTS), span / 2 + room));
  const fittedValues = orbit.fit({ ...values, Pitch: ROBOT_PITCH }, { min: add(min, [1, 1, 1], -room), max: add(max, [1, 1, 1], room) }, size);
  const maxDistance = number(fittedValues, "Distance", 0);
  const computeCoveredShare = (viewpoint: Vector): number => ring.filter((position) => !isSeen(viewpoint, position)).length / RING_POINTS;
  for (const nearer of NEARER) {
    let bestView: { score: number; values: ViewValues } | null = null;
    for (const { most, pitch, side } of DIRECTIONS) {
      if (bestView && most <= bestView.score) continue;
      const Yaw = wrapYaw(number(values, "Yaw", 0) + side);
      const Pitch = ROBOT_PITCH + pitch;
      const viewpoint = add(center, computeOrbitDirection(Yaw, Pitch), nearer * maxDistance);
      if (!isSeen(viewpoint, center) || !isSeen(viewpoint, top)) continue;
      const score = most - computeCoveredShare(viewpoint);
      if (!bestView || score > bestView.score) bestView = { score, values: { ...fittedValues, Yaw, Pitch, Distance: nearer * maxDistance } };
    }
    if (bestView) return bestView.values;
  }
  return fittedValues;
}
