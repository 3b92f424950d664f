/**
 * RViz's Orbit view as plain numbers: where the eye is and what each motion of the mouse does.
 * Constants and signs are those of rviz_default_plugins' OrbitViewController. Lengths are metres, angles radians.
 */

export type Vector = readonly [number, number, number];

export interface Orbit {
  readonly distance: number;
  readonly yaw: number;
  readonly pitch: number;
  readonly focal: Vector;
  readonly invertZ: boolean;
}

/** The camera's axes in the fixed frame; `back` points from the focal point to the eye. */
export interface CameraAxes {
  right: Vector;
  up: Vector;
  back: Vector;
}

/** Ogre's default vertical field of view. */
export const FIELD_OF_VIEW = Math.PI / 4;
export const ZERO_ORBIT: Orbit = { distance: 10, yaw: 0.785398, pitch: 0.785398, focal: [0, 0, 0], invertZ: false };
const PITCH_LIMIT = Math.PI / 2 - 0.001;
const SMALLEST_DISTANCE = 0.01;
const ROTATE_PER_PIXEL = 0.005;
const ZOOM_PER_PIXEL = 0.1;
const ZOOM_PER_WHEEL_UNIT = 0.001;

export function wrapYaw(yaw: number): number {
  const turn = 2 * Math.PI;
  // What is in range stays as the user wrote it, to the last digit.
  if (yaw >= 0 && yaw < turn) return yaw;
  return ((yaw % turn) + turn) % turn;
}

export function clampPitch(pitch: number): number {
  return Math.max(-PITCH_LIMIT, Math.min(PITCH_LIMIT, pitch));
}

export function clampDistance(distance: number): number {
  return Math.max(SMALLEST_DISTANCE, distance);
}

export function cameraAxes(orbit: Orbit): CameraAxes {
  const sign = orbit.invertZ ? -1 : 1;
  const yaw = orbit.yaw * sign;
  const pitch = orbit.pitch * sign;
  const back: Vector = [Math.cos(yaw) * Math.cos(pitch), Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch)];
  const flat: Vector = [-back[1] * sign, back[0] * sign, 0];
  const length = Math.hypot(flat[0], flat[1]);
  const right: Vector = [flat[0] / length, flat[1] / length, 0];
  return { right, up: cross(back, right), back };
}

/** Position of the eye, relative to the target frame. */
export function eye(orbit: Orbit): Vector {
  const { back } = cameraAxes(orbit);
  return add(orbit.focal, back, orbit.distance);
}

/** Left drag. */
export function rotate(orbit: Orbit, dx: number, dy: number): Orbit {
  return {
    ...orbit,
    yaw: wrapYaw(orbit.yaw - dx * ROTATE_PER_PIXEL),
    pitch: clampPitch(orbit.pitch + dy * ROTATE_PER_PIXEL),
  };
}

/** Middle drag: the focal point follows the pointer in the camera's plane. `height` is the view's, in pixels. */
export function pan(orbit: Orbit, dx: number, dy: number, height: number): Orbit {
  const metresPerPixel = (2 * orbit.distance * Math.tan(FIELD_OF_VIEW / 2)) / Math.max(1, height);
  const { right, up } = cameraAxes(orbit);
  return { ...orbit, focal: add(add(orbit.focal, right, -dx * metresPerPixel), up, dy * metresPerPixel) };
}

/** Right drag: downwards moves the eye away. */
export function zoomDrag(orbit: Orbit, dy: number): Orbit {
  return { ...orbit, distance: clampDistance(orbit.distance + dy * ZOOM_PER_PIXEL * (orbit.distance / 10)) };
}

/** Shift and right drag: eye and focal point move along the line of sight. */
export function dollyDrag(orbit: Orbit, dy: number): Orbit {
  return dolly(orbit, dy * ZOOM_PER_PIXEL * (orbit.distance / 10));
}

/** Wheel; `delta` is 120 a notch, positive away from the user. */
export function zoomWheel(orbit: Orbit, delta: number): Orbit {
  return { ...orbit, distance: clampDistance(orbit.distance - delta * ZOOM_PER_WHEEL_UNIT * orbit.distance) };
}

/** Shift and wheel. */
export function dollyWheel(orbit: Orbit, delta: number): Orbit {
  return dolly(orbit, -delta * ZOOM_PER_WHEEL_UNIT * orbit.distance);
}

function dolly(orbit: Orbit, amount: number): Orbit {
  return { ...orbit, focal: add(orbit.focal, cameraAxes(orbit).back, amount) };
}

function add(a: Vector, b: Vector, factor: number): Vector {
  return [a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor];
}

function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
