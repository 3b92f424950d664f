import { transformPointToFixed, transformPointToTarget, type Camera, type Target, type ViewSize } from "./camera";
import { computeFraming } from "./fit";
import { rotateZ, type Bounds, type Vector } from "./vector";
import {
  readNumber,
  RADIANS_PER_PIXEL,
  type Drag,
  type DragButtons,
  type PreviousView,
  type Motion,
  type MouseHint,
  type ViewController,
  type ViewValues,
} from "./view-controller";

type MapMotion = Extract<Motion, "rotate2d" | "moveXY" | "zoom">;

const START_SCALE = 10;
const MIN_SCALE = 0.001;
const MIN_ZOOM_FACTOR = 0.001;
const CAMERA_HEIGHT_M = 500;
const ZOOM_PER_PIXEL = 0.01;
const ZOOM_PER_WHEEL_UNIT = 0.001;

/** RViz's TopDownOrtho: an orthographic view straight down; x points right at angle 0. */
export class TopDownOrthoController implements ViewController {
  readonly followsYaw = false;
  readonly focalColor = 0xffff00;

  computeCamera(values: ViewValues): Camera {
    const scale = readScale(values);
    const angle = readNumber(values, "Angle", 0);
    // A negative scale, which RViz allows by a fast drag, mirrors the view in both directions.
    const sign = Math.sign(scale);
    return {
      position: [readNumber(values, "X", 0), readNumber(values, "Y", 0), CAMERA_HEIGHT_M],
      right: rotateZ([sign, 0, 0], angle),
      up: rotateZ([0, sign, 0], angle),
      back: [0, 0, 1],
      scale: Math.abs(scale),
      focal: null,
    };
  }

  zero(): ViewValues {
    return { Scale: START_SCALE, Angle: 0, X: 0, Y: 0 };
  }

  drag(values: ViewValues, drag: Drag): ViewValues {
    const { isLeftDown, isMiddleDown, isRightDown, dx, dy } = drag;
    if (!isLeftDown && !isMiddleDown && !isRightDown) return {};
    const scale = readScale(values);
    switch (this.motionOf(drag)) {
      case "rotate2d":
        return { Angle: readNumber(values, "Angle", 0) + dx * RADIANS_PER_PIXEL };
      case "moveXY":
        return shiftValues(values, rotateZ([-dx / scale, dy / scale, 0], readNumber(values, "Angle", 0)));
      case "zoom":
        return { Scale: zoomScale(scale, 1 - dy * ZOOM_PER_PIXEL) };
    }
  }

  applyWheel(values: ViewValues, delta: number): ViewValues {
    return { Scale: zoomScale(readScale(values), 1 + delta * ZOOM_PER_WHEEL_UNIT) };
  }

  lookAt(_values: ViewValues, [x, y]: Vector): ViewValues {
    return { X: x, Y: y };
  }

  fit(values: ViewValues, box: Bounds, size: ViewSize): ViewValues {
    const { center, scale } = computeFraming(this.computeCamera(values), values, box, size);
    return { X: center[0], Y: center[1], ...(scale > 0 ? { Scale: Math.sign(readScale(values)) * scale } : {}) };
  }

  mimic({ cls, values, camera }: PreviousView): ViewValues {
    if (cls === "rviz_default_plugins/TopDownOrtho") {
      return { Scale: readScale(values), Angle: readNumber(values, "Angle", 0), X: camera.position[0], Y: camera.position[1] };
    }
    const [x, y] = camera.focal ?? camera.position;
    return { X: x, Y: y };
  }

  retarget(values: ViewValues, oldTarget: Target, newTarget: Target): ViewValues {
    const [x, y] = transformPointToTarget(transformPointToFixed([readNumber(values, "X", 0), readNumber(values, "Y", 0), 0], oldTarget), newTarget);
    return { X: x, Y: y };
  }

  motionOf({ isLeftDown, isMiddleDown, isRightDown, isShiftDown }: DragButtons): MapMotion {
    if (isLeftDown && !isShiftDown) return "rotate2d";
    if (isMiddleDown || isLeftDown) return "moveXY";
    if (isRightDown) return "zoom";
    return isShiftDown ? "moveXY" : "rotate2d";
  }

  hintFor(isShiftDown: boolean): MouseHint {
    return isShiftDown ? "mapShift" : "map";
  }
}

function zoomScale(scale: number, factor: number): number {
  return clampScale(scale * Math.max(MIN_ZOOM_FACTOR, factor));
}

function readScale(values: ViewValues): number {
  return clampScale(readNumber(values, "Scale", START_SCALE));
}

/** Keeps the scale away from zero, without changing its sign. */
function clampScale(scale: number): number {
  return scale < 0 ? Math.min(-MIN_SCALE, scale) : Math.max(MIN_SCALE, scale);
}

function shiftValues(values: ViewValues, [x, y]: Vector): ViewValues {
  return { X: readNumber(values, "X", 0) + x, Y: readNumber(values, "Y", 0) + y };
}
