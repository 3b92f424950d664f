import type { AddEntity, EntityChange, WorldEntity } from "../../protocol";
import { snap } from "./snapping";

export type NewKind = AddEntity["shape"];
export type Shape = NonNullable<WorldEntity["shape"]>;
/** A position on the ground: x and y in the world, m. */
export type GroundPosition = readonly [number, number];

/** A change of an entity; omitted properties stay. */
export type Change = Pick<EntityChange, "name"> & Partial<EntityChange>;

/** The thickness and height of new walls, m. */
const WALL_THICKNESS_M = 0.1;
const WALL_HEIGHT_M = 1;
/** The minimum size, m. */
export const MIN_SIZE_M = 0.001;

/** The sizes of new entities, m, as on the server: x y z; radius and length of a cylinder; radius of a sphere. */
const DEFAULT_SIZES_M: Readonly<Partial<Record<NewKind, readonly number[]>>> = {
  box: [0.5, 0.5, 0.5],
  cylinder: [0.25, 0.5],
  sphere: [0.25],
  ramp: [1, 0.5, 0.25],
};
/** The height of new lights, m. */
const LIGHT_HEIGHTS_M: Readonly<Partial<Record<NewKind, number>>> = { point_light: 2, spot_light: 2, directional_light: 5 };

/** The pose of an entity in the world, and its size. */
export interface Placement {
  readonly pose: readonly number[];
  readonly size: readonly number[];
}

/** Returns the placement of a new entity on the ground. */
export function placementAt(kind: NewKind, [x, y]: GroundPosition): Placement {
  const size = DEFAULT_SIZES_M[kind] ?? [];
  const z = LIGHT_HEIGHTS_M[kind] ?? (isShape(kind) ? computeRestingHeight(kind, size) : 0);
  return { pose: [x, y, z, 0, 0, 0], size };
}

/** Returns the wall between two positions on the ground; null if they are too close. */
export function wallPlacementBetween(a: GroundPosition, b: GroundPosition): Placement | null {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy);
  if (length < WALL_THICKNESS_M / 2) return null;
  const size = [length, WALL_THICKNESS_M, WALL_HEIGHT_M];
  return { pose: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, computeRestingHeight("wall", size), 0, 0, Math.atan2(dy, dx)], size };
}

/** Returns the height of a shape's origin when it rests on the ground, m. */
function computeRestingHeight(shape: Shape, size: readonly number[]): number {
  const [first = 0, second = 0, third = 0] = size;
  if (shape === "sphere") return first;
  return (shape === "cylinder" ? second : third) / 2;
}

/** Scales a size along x, y and z; a round dimension follows its axis that is scaled most. */
export function scaleSize(shape: Shape, size: readonly number[], scale: readonly number[], step: number): number[] {
  const [sx = 1, sy = 1, sz = 1] = scale;
  const factors = shape === "sphere" ? [chooseLargestFactor(sx, sy, sz)] : shape === "cylinder" ? [chooseLargestFactor(sx, sy), sz] : [sx, sy, sz];
  // Dimensions that are not scaled may remain off the grid.
  return size.map((length, i) => {
    const factor = Math.abs(factors[i] ?? 1);
    return factor === 1 ? length : Math.max(step || MIN_SIZE_M, snap(length * factor, step));
  });
}

/** Returns the change that resizes an entity; the bottom of an entity that is not tilted stays at its height. */
export function createResizeChange({ name, shape, size: oldSize, pose }: WorldEntity, size: readonly number[]): Change {
  const [x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0] = pose;
  const change = { name, size: [...size] };
  if (shape === null || roll !== 0 || pitch !== 0) return change;
  const rise = computeRestingHeight(shape, size) - computeRestingHeight(shape, oldSize);
  return rise === 0 ? change : { ...change, pose: [x, y, roundNoise(z + rise), roll, pitch, yaw] };
}

/** Rounds away floating-point errors. */
export function roundNoise(value: number): number {
  return Math.round(value * 1e9) / 1e9;
}

/** Returns the factors by which to stretch the drawing of a shape along x, y and z for another size. */
export function computeStretchFactors(shape: Shape, oldSize: readonly number[], newSize: readonly number[]): [number, number, number] {
  const factorAt = (i: number): number => ((oldSize[i] ?? 0) > 0 ? (newSize[i] ?? 0) / (oldSize[i] ?? 1) : 1);
  if (shape === "sphere") return [factorAt(0), factorAt(0), factorAt(0)];
  return shape === "cylinder" ? [factorAt(0), factorAt(0), factorAt(1)] : [factorAt(0), factorAt(1), factorAt(2)];
}

export function isShape(kind: NewKind): kind is Shape {
  return kind === "wall" || kind in DEFAULT_SIZES_M;
}

function chooseLargestFactor(...factors: number[]): number {
  return factors.reduce((largest, factor) => (Math.abs(Math.log(Math.abs(factor))) > Math.abs(Math.log(Math.abs(largest))) ? factor : largest), 1);
}
