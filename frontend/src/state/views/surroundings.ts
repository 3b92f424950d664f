import { add, scale, subtract, rotateZ, type Bounds, type Vector } from "./vector";
import { computeOrbitDirection, OrbitController } from "./orbit";
import { readNumber, wrapYaw, type ViewValues } from "./view-controller";
import type { ViewSize } from "./camera";

/** The margin around a robot in a world: a factor of its size, and its minimum in m. */
const MARGIN_FACTOR = 0.75;
/** The pitch from which a robot, and a world without robots, is viewed, rad above the horizon. */
const ROBOT_PITCH_RAD = 0.5;
const OVERVIEW_PITCH_RAD = 0.785398;
/** The changes of pitch, yaw and distance to try if objects hide the robot or its surroundings. */
const PITCH_OFFSETS_RAD = [0, 0.3, 0.6, 0.9];
const YAW_OFFSETS_RAD = [0, -Math.PI / 2, Math.PI / 2, Math.PI];
const DISTANCE_FACTORS = [1, 0.6, 0.35];
/** The share of the surroundings that must become visible to justify a higher pitch, or another side. */
const PITCH_COST = 0.15;
const YAW_COST = 0.05;
/** The number of positions around a robot whose visibility counts. */
const RING_POINT_COUNT = 8;
/** The directions to try, with the maximum score of each. */
const DIRECTIONS = PITCH_OFFSETS_RAD.flatMap((pitchOffset, pitchIndex) =>
  YAW_OFFSETS_RAD.map((yawOffset, yawIndex) => ({ pitchOffset, yawOffset, maxScore: 1 - pitchIndex * PITCH_COST - yawIndex * YAW_COST })),
);
const orbit = new OrbitController();

/** Returns whether nothing hides a position from a viewpoint. */
export type IsVisible = (viewpoint: Vector, position: Vector) => boolean;

/** Returns the values of an Orbit view of a whole world from above. */
export function computeOverview(values: ViewValues, world: Bounds, size: ViewSize): ViewValues {
  const startValues = { ...values, Pitch: OVERVIEW_PITCH_RAD };
  return { Pitch: OVERVIEW_PITCH_RAD, ...orbit.fit(startValues, world, size) };
}

/** Returns the values of an Orbit view of a robot and its surroundings, from where most of both is visible. */
export function computeViewAround(values: ViewValues, { min, max }: Bounds, size: ViewSize, isVisible: IsVisible): ViewValues {
  const robotSize = Math.max(...subtract(max, min));
  const margin = Math.max(MARGIN_FACTOR, MARGIN_FACTOR * robotSize);
  const center = scale(add(min, max), 0.5);
  const top: Vector = [center[0], center[1], max[2]];
  const ring = Array.from({ length: RING_POINT_COUNT }, (_, i) => add(center, rotateZ([1, 0, 0], (i * 2 * Math.PI) / RING_POINT_COUNT), robotSize / 2 + margin));
  const fittedValues = orbit.fit({ ...values, Pitch: ROBOT_PITCH_RAD }, { min: add(min, [1, 1, 1], -margin), max: add(max, [1, 1, 1], margin) }, size);
  const maxDistance = readNumber(fittedValues, "Distance", 0);
  const computeHiddenShare = (viewpoint: Vector): number => ring.filter((position) => !isVisible(viewpoint, position)).length / RING_POINT_COUNT;
  for (const distanceFactor of DISTANCE_FACTORS) {
    let bestView: { score: number; values: ViewValues } | null = null;
    for (const { maxScore, pitchOffset, yawOffset } of DIRECTIONS) {
      if (bestView && maxScore <= bestView.score) continue;
      const Yaw = wrapYaw(readNumber(values, "Yaw", 0) + yawOffset);
      const Pitch = ROBOT_PITCH_RAD + pitchOffset;
      const viewpoint = add(center, computeOrbitDirection(Yaw, Pitch), distanceFactor * maxDistance);
      if (!isVisible(viewpoint, center) || !isVisible(viewpoint, top)) continue;
      const score = maxScore - computeHiddenShare(viewpoint);
      if (!bestView || score > bestView.score) bestView = { score, values: { ...fittedValues, Yaw, Pitch, Distance: distanceFactor * maxDistance } };
    }
    if (bestView) return bestView.values;
  }
  return fittedValues;
}
