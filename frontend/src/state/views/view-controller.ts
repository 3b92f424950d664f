import type { PropertyValue } from "../../protocol";
import type { Camera, Target, ViewSize } from "./camera";
import type { Bounds, Vector } from "./vector";

/** The values of a view by the paths of their properties: `Distance`, `Focal Point/X`. */
export type ViewValues = Readonly<Record<string, PropertyValue>>;

/** A movement of the mouse in pixels, with its buttons. */
export interface Drag extends ViewSize {
  readonly isLeftDown: boolean;
  readonly isMiddleDown: boolean;
  readonly isRightDown: boolean;
  readonly isShiftDown: boolean;
  /** The previous position, from the upper left corner. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
}

/** The mouse buttons and the key of a `Drag` that decide on the motion. */
export type DragButtons = Pick<Drag, "isLeftDown" | "isMiddleDown" | "isRightDown" | "isShiftDown">;

/** The motion of the camera caused by the mouse; each has its own cursor. */
export type Motion = "rotate3d" | "rotate2d" | "moveXY" | "moveZ" | "zoom";

/** The text of the status line about the mouse buttons. */
export type MouseHint = "orbit" | "orbitShift" | "groundShift" | "fly" | "flyShift" | "map" | "mapShift";

/** The view to imitate: its class, its values, and its camera in the frame of the new view's target. */
export interface PreviousView {
  readonly cls: string;
  readonly values: ViewValues;
  readonly camera: Camera;
}

/**
 * One of RViz's view classes: the meaning of its values, and how the mouse changes them. All values are in the frame of
 * the view's target, in m and rad; methods return the values that change.
 */
export interface ViewController {
  /** Whether the view rotates with the target's yaw, too. */
  readonly followsYaw: boolean;
  /** The color of the disc at the focal point. */
  readonly focalColor: number;
  computeCamera(values: ViewValues): Camera;
  /** Returns the values of RViz's Zero button. */
  zero(): ViewValues;
  drag(values: ViewValues, drag: Drag): ViewValues;
  /** Handles the wheel; `delta` is 120 per notch, positive away from the user. */
  applyWheel(values: ViewValues, delta: number, isShiftDown: boolean): ViewValues;
  lookAt(values: ViewValues, point: Vector): ViewValues;
  /** Fits a box into view from the current direction, in a canvas of this size. */
  fit(values: ViewValues, box: Bounds, size: ViewSize): ViewValues;
  /** Imitates another view, as far as RViz does. */
  mimic(previous: PreviousView): ViewValues;
  /** Converts the values to another target frame without moving the camera. */
  retarget(values: ViewValues, oldTarget: Target, newTarget: Target): ViewValues;
  motionOf(drag: DragButtons): Motion;
  hintFor(isShiftDown: boolean): MouseHint;
}

const PITCH_LIMIT_RAD = Math.PI / 2 - 0.001;
export const RADIANS_PER_PIXEL = 0.005;

export function readNumber(values: ViewValues, name: string, fallback: number): number {
  const value = values[name];
  return typeof value === "number" ? value : fallback;
}

export function readVector(values: ViewValues, name: string, fallback: Vector): Vector {
  const readComponent = (axis: "X" | "Y" | "Z", i: 0 | 1 | 2): number => readNumber(values, `${name}/${axis}`, fallback[i]);
  return [readComponent("X", 0), readComponent("Y", 1), readComponent("Z", 2)];
}

export function createVectorValues(name: string, [x, y, z]: Vector): ViewValues {
  return { [`${name}/X`]: x, [`${name}/Y`]: y, [`${name}/Z`]: z };
}

export function wrapYaw(yaw: number): number {
  const fullTurn = 2 * Math.PI;
  // Keep a value in range exactly as the user wrote it.
  if (yaw >= 0 && yaw < fullTurn) return yaw;
  return ((yaw % fullTurn) + fullTurn) % fullTurn;
}

export function clampPitch(pitch: number): number {
  return Math.max(-PITCH_LIMIT_RAD, Math.min(PITCH_LIMIT_RAD, pitch));
}
