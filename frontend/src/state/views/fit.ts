import { FIELD_OF_VIEW_RAD, transformPointToTarget, type Camera, type Target, type ViewSize } from "./camera";
import { add, dot, scale, subtract, type Bounds, type Vector } from "./vector";
import { readNumber, type ViewValues } from "./view-controller";

/** The margin around the box, as a factor of its size. */
const MARGIN_FACTOR = 1.2;
/** The minimum near clip distance, and its share of the distance to the box. */
const MIN_NEAR_CLIP_M = 0.001;
const NEAR_CLIP_SHARE = 0.25;
const NEAR_CLIP_PATH = "Near Clip Distance";

/** The framing of a box from the direction of a camera. */
export interface Framing {
  /** The center of the box. */
  readonly center: Vector;
  /** The distance from the center to a perspective camera, m; 0 for a single point. */
  readonly distance: number;
  /** Pixels per meter of an orthographic camera; 0 for a single point. */
  readonly scale: number;
  /** The values that keep the near clip plane in front of the whole box. */
  readonly clip: ViewValues;
}

/**
 * Returns the framing that shows a whole box as large as a canvas of this size permits. `values` are those of the
 * camera's view.
 */
export function computeFraming(camera: Camera, values: ViewValues, bounds: Bounds, { width, height }: ViewSize): Framing {
  const { right, up, back } = camera;
  const center = scale(add(bounds.min, bounds.max), 0.5);
  const tangent = Math.tan(FIELD_OF_VIEW_RAD / 2) / MARGIN_FACTOR;
  let [distance, metersPerPixel, frontDepth] = [0, 0, 0];
  for (const point of bounds.points ?? cornersOf(bounds)) {
    const corner = subtract(point, center);
    const [horizontal, vertical] = [Math.abs(dot(corner, right)), Math.abs(dot(corner, up))];
    distance = Math.max(distance, dot(corner, back) + Math.max(vertical, (horizontal * height) / width) / tangent);
    metersPerPixel = Math.max(metersPerPixel, (2 * horizontal) / width, (2 * vertical) / height);
    frontDepth = Math.max(frontDepth, dot(corner, back));
  }
  const clipDistance = NEAR_CLIP_SHARE * (distance - frontDepth);
  const isClipped = clipDistance > 0 && readNumber(values, NEAR_CLIP_PATH, 0) > clipDistance;
  return {
    center,
    distance,
    scale: metersPerPixel > 0 ? 1 / (metersPerPixel * MARGIN_FACTOR) : 0,
    clip: isClipped ? { [NEAR_CLIP_PATH]: Math.max(MIN_NEAR_CLIP_M, clipDistance) } : {},
  };
}

/** Returns the bounding box in a target's frame of a box in the fixed frame. */
export function transformBounds(bounds: Bounds, target: Target): Bounds {
  const cornersInTarget = cornersOf(bounds).map((corner) => transformPointToTarget(corner, target));
  const points = bounds.points?.map((point) => transformPointToTarget(point, target));
  const extremeOf = (choose: (...coordinates: number[]) => number): Vector => {
    const chooseCoordinate = (i: 0 | 1 | 2): number => choose(...cornersInTarget.map((corner) => corner[i]));
    return [chooseCoordinate(0), chooseCoordinate(1), chooseCoordinate(2)];
  };
  return { min: extremeOf(Math.min), max: extremeOf(Math.max), ...(points ? { points } : {}) };
}

/** Whether a box contains another. */
export function containsBounds(outer: Bounds, inner: Bounds): boolean {
  return ([0, 1, 2] as const).every((i) => outer.min[i] <= inner.min[i] && inner.max[i] <= outer.max[i]);
}

function cornersOf({ min, max }: Bounds): Vector[] {
  const ends = [min, max];
  return ends.flatMap(([x]) => ends.flatMap(([, y]) => ends.map(([, , z]): Vector => [x, y, z])));
}
