import { add, dot, scale, subtract, rotateZ, normalize, type Vector } from "./vector";

/** Ogre's default vertical field of view, which RViz does not change. */
export const FIELD_OF_VIEW_RAD = Math.PI / 4;

/** The pose and projection of a camera. */
export interface Camera {
  readonly position: Vector;
  /** Perpendicular unit vectors; the camera looks against `back`. */
  readonly right: Vector;
  readonly up: Vector;
  readonly back: Vector;
  /** Pixels per meter of an orthographic camera; null for a perspective camera. */
  readonly scale: number | null;
  /** The point about which the camera orbits, if there is one. */
  readonly focal: Vector | null;
}

/** A frame with which a camera moves: its position, and its rotation about z in rad. */
export interface Target {
  readonly position: Vector;
  readonly yaw: number;
}

export const FIXED_TARGET: Target = { position: [0, 0, 0], yaw: 0 };

export interface Ray {
  readonly origin: Vector;
  /** A unit vector. */
  readonly direction: Vector;
}

/** The size of the view, pixels. */
export interface ViewSize {
  readonly width: number;
  readonly height: number;
}

export function transformPointToFixed(point: Vector, target: Target): Vector {
  return add(rotateZ(point, target.yaw), target.position);
}

export function transformPointToTarget(point: Vector, target: Target): Vector {
  return rotateZ(subtract(point, target.position), -target.yaw);
}

/** Converts a camera from a target's frame to the fixed frame. */
export function transformToFixed(camera: Camera, target: Target): Camera {
  return transformCamera(camera, (point) => transformPointToFixed(point, target), target.yaw);
}

/** Converts a camera from the fixed frame to a target's frame. */
export function transformToTarget(camera: Camera, target: Target): Camera {
  return transformCamera(camera, (point) => transformPointToTarget(point, target), -target.yaw);
}

/** Returns the ray from the camera through a pixel, counted from the upper left corner. */
export function castRay(camera: Camera, x: number, y: number, { width, height }: ViewSize): Ray {
  const forward = scale(camera.back, -1);
  if (camera.scale !== null) {
    const [right, upward] = [(x - width / 2) / camera.scale, (height / 2 - y) / camera.scale];
    return { origin: add(add(camera.position, camera.right, right), camera.up, upward), direction: forward };
  }
  const metersPerPixel = (2 * Math.tan(FIELD_OF_VIEW_RAD / 2)) / height; // a pixel, 1 m from the camera
  const direction = add(add(forward, camera.right, (x - width / 2) * metersPerPixel), camera.up, (height / 2 - y) * metersPerPixel);
  return { origin: camera.position, direction: normalize(direction) };
}

/** Returns the intersection of a ray with the plane z = 0; null if the ray does not reach it. */
export function intersectGround({ origin, direction }: Ray): Vector | null {
  const distance = -origin[2] / direction[2];
  if (!Number.isFinite(distance) || distance < 0) return null;
  return add(origin, direction, distance);
}

function transformCamera(camera: Camera, transformPoint: (point: Vector) => Vector, yaw: number): Camera {
  return {
    position: transformPoint(camera.position),
    right: rotateZ(camera.right, yaw),
    up: rotateZ(camera.up, yaw),
    back: rotateZ(camera.back, yaw),
    scale: camera.scale,
    focal: camera.focal && transformPoint(camera.focal),
  };
}

/** Returns the size of a pixel at a point, m. */
export function computePixelSize(camera: Camera, point: Vector, { height }: ViewSize): number {
  if (camera.scale !== null) return 1 / camera.scale;
  const depth = Math.max(1e-3, dot(subtract(camera.position, point), camera.back));
  return (2 * depth * Math.tan(FIELD_OF_VIEW_RAD / 2)) / height;
}
