/** x, y, z: a position in m, or a direction. */
export type Vector = readonly [number, number, number];

/** An axis-aligned box in a frame: its minimum and maximum corner, m. */
export interface Bounds {
  readonly min: Vector;
  readonly max: Vector;
  /** Points of the content; if given, they are framed instead of the corners. */
  readonly points?: readonly Vector[];
}

export const ORIGIN: Vector = [0, 0, 0];

/** Returns `a + factor * b`. */
export function add(a: Vector, b: Vector, factor = 1): Vector {
  return [a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor];
}

export function subtract(a: Vector, b: Vector): Vector {
  return add(a, b, -1);
}

export function scale(a: Vector, factor: number): Vector {
  return [a[0] * factor, a[1] * factor, a[2] * factor];
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function length(a: Vector): number {
  return Math.hypot(...a);
}

export function distanceBetween(a: Vector, b: Vector): number {
  return length(subtract(a, b));
}

export function normalize(a: Vector): Vector {
  return scale(a, 1 / (length(a) || 1));
}

/** Rotates about z, rad. */
export function rotateZ(a: Vector, angle: number): Vector {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return [a[0] * cos - a[1] * sin, a[0] * sin + a[1] * cos, a[2]];
}
