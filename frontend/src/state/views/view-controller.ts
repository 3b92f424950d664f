import type { PropertyValue } from "../../protocol";
import type { Camera, Target, ViewSize } from "./camera";
import type { Span, Vector } from "./vector";

/** Values of a view by the paths of their properties: `Distance`, `Focal Point/X`. */
export type ViewValues = Readonly<Record<string, PropertyValue>>;

/** A movement of the mouse: its buttons, and its distance in pixels. */
export interface Drag extends ViewSize {
  readonly left: boolean;
  readonly middle: boolean;
  readonly right: boolean;
  readonly shift: boolean;
  /** Where it was before, from the upper left corner. */
  readonly x: number;
  readonly y: number;
  readonly dx: number;
  readonly dy: number;
}

/** The motion of the camera under the mouse; each has its cursor. */
export type Motion = "rotate3d" | "rotate2d" | "moveXY" | "moveZ" | "zoom";

/** The text of the status line about the buttons. */
export type MouseHint = "orbit" | "orbitShift" | "groundShift" | "fly" | "flyShift" | "map" | "mapShift";

/** The view to look like: its class, its values, and its camera in the frame of the new one's target. */
export interface Look {
  readonly cls: string;
  readonly values: ViewValues;
  readonly camera: Camera;
}

/**
 * One of RViz's view classes: the meaning of its values, and how the mouse changes them. All is in the frame of the
 * view's target, metres and radians; methods return the values that change.
 */
export interface ViewController {
  /** Turns with the target's yaw, too. */
  readonly followsYaw: boolean;
  /** Colour of the disc at the point the camera turns about. */
  readonly focalColor: number;
  camera(values: ViewValues): Camera;
  /** RViz's Zero button. */
  zero(): ViewValues;
  drag(values: ViewValues, drag: Drag): ViewValues;
  /** `delta` is 120 a notch, positive away from the user. */
  wheel(values: ViewValues, delta: number, shift: boolean): ViewValues;
  lookAt(values: ViewValues, point: Vector): ViewValues;
  /** Looks at all of a box from the side that the camera is at, in a canvas of this size. */
  fit(values: ViewValues, box: Span, size: ViewSize): ViewValues;
  /** Looks as another view does, as far as RViz does that. */
  mimic(look: Look): ViewValues;
  /** Another frame became the target: the camera stays where it is. */
  retarget(values: ViewValues, from: Target, to: Target): ViewValues;
  motion(drag: Pick<Drag, "left" | "middle" | "right" | "shift">): Motion;
  hint(shift: boolean): MouseHint;
}

const PITCH_LIMIT = Math.PI / 2 - 0.001;
export const RADIANS_PER_PIXEL = 0.005;

export function number(values: ViewValues, name: string, fallback: number): number {
  const value = values[name];
  return typeof value === "number" ? value : fallback;
}

export function vector(values: ViewValues, name: string, fallback: Vector): Vector {
  const at = (axis: "X" | "Y" | "Z", i: 0 | 1 | 2): number => number(values, `${name}/${axis}`, fallback[i]);
  return [at("X", 0), at("Y", 1), at("Z", 2)];
}

export function vectorValues(name: string, [x, y, z]: Vector): ViewValues {
  return { [`${name}/X`]: x, [`${name}/Y`]: y, [`${name}/Z`]: z };
}

export function wrapYaw(yaw: number): number {
  const turn = 2 * Math.PI;
  // A value in range stays as the user wrote it, to the last digit.
  if (yaw >= 0 && yaw < turn) return yaw;
  return ((yaw % turn) + turn) % turn;
}

export function clampPitch(pitch: number): number {
  return Math.max(-PITCH_LIMIT, Math.min(PITCH_LIMIT, pitch));
}
