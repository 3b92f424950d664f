import { FIELD_OF_VIEW_RAD, transformPointToFixed, transformPointToTarget, type Camera, type Target, type ViewSize } from "./camera";
import { computeFraming } from "./fit";
import { add, cross, distanceBetween, length, ORIGIN, scale, type Bounds, type Vector } from "./vector";
import {
  clampPitch,
  readNumber,
  RADIANS_PER_PIXEL,
  readVector,
  createVectorValues,
  wrapYaw,
  type Drag,
  type DragButtons,
  type PreviousView,
  type Motion,
  type MouseHint,
  type ViewController,
  type ViewValues,
} from "./view-controller";

export type OrbitMotion = Extract<Motion, "rotate3d" | "moveXY" | "moveZ" | "zoom">;

const START_VALUES = { distance: 10, angle: 0.785398 };
const MIN_DISTANCE_M = 0.001;
const ZOOM_PER_PIXEL = 0.1;
const ZOOM_PER_WHEEL_UNIT = 0.001;
/** The height at which RViz places an Orbit view that replaces TopDownOrtho, m. */
const ABOVE_MAP_HEIGHT_M = 100;
/** A small horizontal offset from the vertical, which defines the yaw of the view. */
const HORIZONTAL_OFFSET_M = 0.0001;

/**
 * RViz's Orbit: position = focal + distance (cos yaw cos pitch, sin yaw cos pitch, sin pitch), looking at the focal
 * point. Constants and signs are those of OrbitViewController in rviz_default_plugins.
 */
export class OrbitController implements ViewController {
  readonly followsYaw: boolean = false;
  readonly focalColor: number = 0xffff00;

  computeCamera(values: ViewValues): Camera {
    const { distance, yaw, pitch, focal } = readOrbit(values);
    const sign = values["Invert Z Axis"] === true ? -1 : 1;
    const back = computeOrbitDirection(yaw * sign, pitch * sign);
    const horizontalLength = Math.hypot(back[0], back[1]);
    const right: Vector = [(-back[1] * sign) / horizontalLength, (back[0] * sign) / horizontalLength, 0];
    return { position: add(focal, back, distance), right, up: cross(back, right), back, scale: null, focal };
  }

  zero(): ViewValues {
    return { Distance: START_VALUES.distance, Yaw: START_VALUES.angle, Pitch: START_VALUES.angle, ...createVectorValues("Focal Point", ORIGIN) };
  }

  drag(values: ViewValues, drag: Drag): ViewValues {
    const { distance, yaw, pitch } = readOrbit(values);
    switch (this.motionOf(drag)) {
      case "rotate3d":
        if (!drag.isLeftDown) return {};
        return {
          Yaw: wrapYaw(yaw - drag.dx * RADIANS_PER_PIXEL),
          Pitch: clampPitch(pitch + drag.dy * RADIANS_PER_PIXEL),
        };
      case "moveXY":
        return this.pan(values, drag);
      case "moveZ":
        return this.dolly(values, drag.dy * ZOOM_PER_PIXEL * (distance / 10));
      case "zoom":
        return { Distance: clampDistance(distance + drag.dy * ZOOM_PER_PIXEL * (distance / 10)) };
    }
  }

  applyWheel(values: ViewValues, delta: number, isShiftDown: boolean): ViewValues {
    const { distance } = readOrbit(values);
    const amount = delta * ZOOM_PER_WHEEL_UNIT * distance;
    return isShiftDown ? this.dolly(values, -amount) : { Distance: clampDistance(distance - amount) };
  }

  lookAt(values: ViewValues, point: Vector): ViewValues {
    return orbitFrom(point, this.computeCamera(values).position);
  }

  fit(values: ViewValues, box: Bounds, size: ViewSize): ViewValues {
    const { center, distance, clip } = computeFraming(this.computeCamera(values), values, box, size);
    return { ...createVectorValues("Focal Point", center), ...(distance > 0 ? { Distance: distance } : {}), ...clip };
  }

  mimic({ cls, values, camera }: PreviousView): ViewValues {
    if (cls === "rviz_default_plugins/Orbit") {
      const { distance, focal } = readOrbit(values);
      return { ...orbitFrom(focal, camera.position), Distance: distance };
    }
    if (cls === "rviz_default_plugins/TopDownOrtho") return lookFromAbove(camera.position);
    const distance = length(camera.position);
    return orbitFrom(add(camera.position, camera.back, -distance), camera.position);
  }

  retarget(values: ViewValues, oldTarget: Target, newTarget: Target): ViewValues {
    const { focal, yaw } = readOrbit(values);
    const yawChange = oldTarget.yaw === newTarget.yaw ? {} : { Yaw: wrapYaw(yaw + oldTarget.yaw - newTarget.yaw) };
    return { ...createVectorValues("Focal Point", transformPointToTarget(transformPointToFixed(focal, oldTarget), newTarget)), ...yawChange };
  }

  motionOf({ isLeftDown, isMiddleDown, isRightDown, isShiftDown }: DragButtons): OrbitMotion {
    if (isLeftDown && !isShiftDown) return "rotate3d";
    if (isMiddleDown || (isLeftDown && isShiftDown)) return "moveXY";
    if (isRightDown) return isShiftDown ? "moveZ" : "zoom";
    return isShiftDown ? "moveXY" : "rotate3d";
  }

  hintFor(isShiftDown: boolean): MouseHint {
    return isShiftDown ? "orbitShift" : "orbit";
  }

  /** Moves the focal point with the pointer in the camera's plane. */
  protected pan(values: ViewValues, { dx, dy, height, isLeftDown, isMiddleDown }: Drag): ViewValues {
    if (!isLeftDown && !isMiddleDown) return {};
    const { distance, focal } = readOrbit(values);
    const metersPerPixel = (2 * distance * Math.tan(FIELD_OF_VIEW_RAD / 2)) / Math.max(1, height);
    const { right, up } = this.computeCamera(values);
    return createVectorValues("Focal Point", add(add(focal, right, -dx * metersPerPixel), up, dy * metersPerPixel));
  }

  /** Moves the camera and the focal point along the line of sight. */
  private dolly(values: ViewValues, amount: number): ViewValues {
    return createVectorValues("Focal Point", add(readOrbit(values).focal, this.computeCamera(values).back, amount));
  }
}

export function readOrbit(values: ViewValues): { distance: number; yaw: number; pitch: number; focal: Vector } {
  return {
    distance: clampDistance(readNumber(values, "Distance", START_VALUES.distance)),
    yaw: readNumber(values, "Yaw", START_VALUES.angle),
    pitch: clampPitch(readNumber(values, "Pitch", START_VALUES.angle)),
    focal: readVector(values, "Focal Point", ORIGIN),
  };
}

/** Returns the values of a camera that looks from one point at another. */
export function orbitFrom(focal: Vector, viewpoint: Vector): ViewValues {
  const distance = clampDistance(distanceBetween(focal, viewpoint));
  const [x, y, z] = scale(add(viewpoint, focal, -1), 1 / distance);
  return {
    Distance: distance,
    Yaw: wrapYaw(Math.atan2(y, x)),
    Pitch: clampPitch(Math.asin(Math.max(-1, Math.min(1, z)))),
    ...createVectorValues("Focal Point", focal),
  };
}

/** Returns the values that look straight down at the position of a TopDownOrtho view. */
export function lookFromAbove([x, y]: Vector): ViewValues {
  return orbitFrom([x, y, 0], [x, y - HORIZONTAL_OFFSET_M, ABOVE_MAP_HEIGHT_M]);
}

function clampDistance(distance: number): number {
  return Math.max(MIN_DISTANCE_M, distance);
}

/** Returns the unit vector from the focal point to the camera. */
export function computeOrbitDirection(yaw: number, pitch: number): Vector {
  return [Math.cos(yaw) * Math.cos(pitch), Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch)];
}
