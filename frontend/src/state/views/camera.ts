import { add, dot, scale, subtract, turn, unit, type Vector } from "./vector";

/** Ogre's default vertical field of view, which RViz leaves as it is. */
export const FIELD_OF_VIEW = Math.PI / 4;

/** The pose and projection of a camera. */
export interface Camera {
  readonly position: Vector;
  /** Unit vectors at right angles; the camera looks against `back`. */
  readonly right: Vector;
  readonly up: Vector;
  readonly back: Vector;
  /** Pixels to a metre of an orthographic camera, null of a perspective one. */
  readonly scale: number | null;
  /** The point it turns about, if there is one. */
  readonly focal: Vector | null;
}

/** A frame that a camera moves with: a place, and a rotation about z (radians). */
export interface Target {
  readonly position: Vector;
  readonly yaw: number;
}

export const FIXED: Target = { position: [0, 0, 0], yaw: 0 };

export interface Ray {
  readonly origin: Vector;
  /** Of length 1. */
  readonly direction: Vector;
}

/** The size of the view, pixels. */
export interface ViewSize {
  readonly width: number;
  readonly height: number;
}

export function toFixed(point: Vector, target: Target): Vector {
  return add(turn(point, target.yaw), target.position);
}

export function toTarget(point: Vector, target: Target): Vector {
  return turn(subtract(point, target.position), -target.yaw);
}

/** A camera given in a target's frame, in the fixed frame. */
export function cameraInFixed(camera: Camera, target: Target): Camera {
  return moved(camera, (point) => toFixed(point, target), target.yaw);
}

/** A camera given in the fixed frame, in a target's. */
export function cameraInTarget(camera: Camera, target: Target): Camera {
  return moved(camera, (point) => toTarget(point, target), -target.yaw);
}

/** The ray from the camera through a pixel, counted from the upper left corner. */
export function rayThrough(camera: Camera, x: number, y: number, { width, height }: ViewSize): Ray {
  const back = scale(camera.back, -1);
  if (camera.scale !== null) {
    const [right, up] = [(x - width / 2) / camera.scale, (height / 2 - y) / camera.scale];
    return { origin: add(add(camera.position, camera.right, right), camera.up, up), direction: back };
  }
  const metres = (2 * Math.tan(FIELD_OF_VIEW / 2)) / height; // a pixel, 1 m from the camera
  const towards = add(add(back, camera.right, (x - width / 2) * metres), camera.up, (height / 2 - y) * metres);
  return { origin: camera.position, direction: unit(towards) };
}

/** The intersection of a ray with the plane z = 0; null where it leads away from it. */
export function onGround({ origin, direction }: Ray): Vector | null {
  const distance = -origin[2] / direction[2];
  if (!Number.isFinite(distance) || distance < 0) return null;
  return add(origin, direction, distance);
}

function moved(camera: Camera, place: (point: Vector) => Vector, yaw: number): Camera {
  return {
    position: place(camera.position),
    right: turn(camera.right, yaw),
    up: turn(camera.up, yaw),
    back: turn(camera.back, yaw),
    scale: camera.scale,
    focal: camera.focal && place(camera.focal),
  };
}

/** The size of a pixel at a point, m. */
export function pixelSize(camera: Camera, point: Vector, { height }: ViewSize): number {
  if (camera.scale !== null) return 1 / camera.scale;
  const depth = Math.max(1e-3, dot(subtract(camera.position, point), camera.back));
  return (2 * depth * Math.tan(FIELD_OF_VIEW / 2)) / height;
}
