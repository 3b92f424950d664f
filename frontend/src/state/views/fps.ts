import { transformPointToFixed, transformPointToTarget, type Camera, type Target, type ViewSize } from "./camera";
import { computeFraming } from "./fit";
import { add, cross, length, subtract, type Bounds, type Vector } from "./vector";
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

type FpsMotion = Extract<Motion, "rotate3d" | "moveXY" | "moveZ">;

const START_POSITION: Vector = [5, 5, 10];
const METERS_PER_PIXEL = 0.01;
const METERS_PER_PIXEL_AHEAD = 0.1;
const METERS_PER_WHEEL_UNIT = 0.01;
/** A direction whose z component exceeds this counts as vertical: its yaw is defined by the up direction. */
const MIN_VERTICAL_COMPONENT = 0.99999;

/** RViz's FPS: a flying camera; yaw rotates it about z, pitch tilts it down. */
export class FpsController implements ViewController {
  readonly followsYaw = false;
  readonly focalColor = 0xffff00;

  computeCamera(values: ViewValues): Camera {
    const yaw = readNumber(values, "Yaw", 0);
    const pitch = clampPitch(readNumber(values, "Pitch", 0));
    const back: Vector = [-Math.cos(yaw) * Math.cos(pitch), -Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch)];
    const right: Vector = [Math.sin(yaw), -Math.cos(yaw), 0];
    return { position: readVector(values, "Position", START_POSITION), right, up: cross(back, right), back, scale: null, focal: null };
  }

  zero(): ViewValues {
    return { ...createVectorValues("Position", START_POSITION), ...anglesOf(subtract([0, 0, 0], START_POSITION), [0, 0, 1]) };
  }

  drag(values: ViewValues, drag: Drag): ViewValues {
    const { isLeftDown, isMiddleDown, isRightDown, dx, dy } = drag;
    if (!isLeftDown && !isMiddleDown && !isRightDown) return {};
    switch (this.motionOf(drag)) {
      case "rotate3d":
        return {
          Yaw: wrapYaw(readNumber(values, "Yaw", 0) - dx * RADIANS_PER_PIXEL),
          Pitch: clampPitch(readNumber(values, "Pitch", 0) + dy * RADIANS_PER_PIXEL),
        };
      case "moveXY":
        return this.fly(values, [dx * METERS_PER_PIXEL, -dy * METERS_PER_PIXEL, 0]);
      case "moveZ":
        return this.fly(values, [0, 0, dy * METERS_PER_PIXEL_AHEAD]);
    }
  }

  applyWheel(values: ViewValues, delta: number): ViewValues {
    return this.fly(values, [0, 0, -delta * METERS_PER_WHEEL_UNIT]);
  }

  lookAt(values: ViewValues, point: Vector): ViewValues {
    const { position, up } = this.computeCamera(values);
    return anglesOf(subtract(point, position), up);
  }

  fit(values: ViewValues, box: Bounds, size: ViewSize): ViewValues {
    const camera = this.computeCamera(values);
    const { center, distance, clip } = computeFraming(camera, values, box, size);
    return distance > 0 ? { ...createVectorValues("Position", add(center, camera.back, distance)), ...clip } : this.lookAt(values, center);
  }

  mimic({ camera }: PreviousView): ViewValues {
    const forward = subtract([0, 0, 0], camera.back);
    return { ...createVectorValues("Position", camera.position), ...anglesOf(forward, camera.up) };
  }

  retarget(values: ViewValues, oldTarget: Target, newTarget: Target): ViewValues {
    return createVectorValues("Position", transformPointToTarget(transformPointToFixed(readVector(values, "Position", START_POSITION), oldTarget), newTarget));
  }

  motionOf({ isLeftDown, isMiddleDown, isRightDown, isShiftDown }: DragButtons): FpsMotion {
    if (isLeftDown && !isShiftDown) return "rotate3d";
    if (isMiddleDown || isLeftDown) return "moveXY";
    if (isRightDown) return "moveZ";
    return isShiftDown ? "moveXY" : "rotate3d";
  }

  hintFor(isShiftDown: boolean): MouseHint {
    return isShiftDown ? "flyShift" : "fly";
  }

  /** Moves along the camera's own axes: right, up, back. */
  private fly(values: ViewValues, [x, y, z]: Vector): ViewValues {
    const { position, right, up, back } = this.computeCamera(values);
    return createVectorValues("Position", add(add(add(position, right, x), up, y), back, z));
  }
}

/** Returns yaw and pitch of a direction; `up` defines the yaw of a vertical one. */
function anglesOf(forward: Vector, up: Vector): ViewValues {
  const distance = length(forward);
  if (distance === 0) return {};
  const descent = -forward[2] / distance;
  const [x, y] = Math.abs(descent) > MIN_VERTICAL_COMPONENT ? [up[0] * descent, up[1] * descent] : forward;
  return {
    Yaw: wrapYaw(Math.atan2(y, x)),
    Pitch: clampPitch(Math.asin(Math.max(-1, Math.min(1, descent)))),
  };
}
