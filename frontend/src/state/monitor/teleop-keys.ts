/** A direction of motion, components from -1 to 1: forward, left, up, and turning left. */
export interface Motion {
  x: number;
  y: number;
  z: number;
  turn: number;
}

export const STILL: Motion = { x: 0, y: 0, z: 0, turn: 0 };

const makeMotion = (x: number, turn = 0, y = 0, z = 0): Motion => ({ x, y, z, turn });

/** The keys of teleop_twist_keyboard, the arrow keys, and WASD. With Shift they move sideways instead of turning. */
const KEYS: Readonly<Record<string, Motion>> = {
  i: makeMotion(1),
  o: makeMotion(1, -1),
  j: makeMotion(0, 1),
  l: makeMotion(0, -1),
  u: makeMotion(1, 1),
  ",": makeMotion(-1),
  ".": makeMotion(-1, 1),
  m: makeMotion(-1, -1),
  I: makeMotion(1),
  O: makeMotion(1, 0, -1),
  J: makeMotion(0, 0, 1),
  L: makeMotion(0, 0, -1),
  U: makeMotion(1, 0, 1),
  "<": makeMotion(-1),
  ">": makeMotion(-1, 0, -1),
  M: makeMotion(-1, 0, 1),
  t: makeMotion(0, 0, 0, 1),
  b: makeMotion(0, 0, 0, -1),
  w: makeMotion(1),
  s: makeMotion(-1),
  a: makeMotion(0, 1),
  d: makeMotion(0, -1),
  W: makeMotion(1),
  S: makeMotion(-1),
  A: makeMotion(0, 0, 1),
  D: makeMotion(0, 0, -1),
  ArrowUp: makeMotion(1),
  ArrowDown: makeMotion(-1),
  ArrowLeft: makeMotion(0, 1),
  ArrowRight: makeMotion(0, -1),
};

const SIDEWAYS: Readonly<Record<string, Motion>> = { ArrowLeft: makeMotion(0, 0, 1), ArrowRight: makeMotion(0, 0, -1) };

/** Returns the motion of a key; null for other keys. */
export function motionOfKey(key: string, isShiftDown: boolean): Motion | null {
  return (isShiftDown ? SIDEWAYS[key] : undefined) ?? KEYS[key] ?? null;
}

/** Returns the sum of several motions, clamped to -1 to 1. */
export function sumOf(motions: Iterable<Motion>): Motion {
  const sum = { ...STILL };
  for (const motion of motions) {
    sum.x += motion.x;
    sum.y += motion.y;
    sum.z += motion.z;
    sum.turn += motion.turn;
  }
  return { x: clampToUnit(sum.x), y: clampToUnit(sum.y), z: clampToUnit(sum.z), turn: clampToUnit(sum.turn) };
}

export function isStill(motion: Motion): boolean {
  return motion.x === 0 && motion.y === 0 && motion.z === 0 && motion.turn === 0;
}

/** Returns the deflection of a stick, -1 to 1, without the dead zone around its center. */
export function computeDeflection(value: number, deadZone = 0.12): number {
  const excess = Math.abs(value) - deadZone;
  return excess <= 0 ? 0 : clampToUnit((Math.sign(value) * excess) / (1 - deadZone));
}

function clampToUnit(value: number): number {
  return Math.min(1, Math.max(-1, value));
}
