/** A direction of motion, components from -1 to 1: forward, left, up, and turning left. */
export interface Motion {
  x: number;
  y: number;
  z: number;
  turn: number;
}

export const NO_MOTION: Motion = { x: 0, y: 0, z: 0, turn: 0 };

const createMotion = (x: number, turn = 0, y = 0, z = 0): Motion => ({ x, y, z, turn });

/** The keys of teleop_twist_keyboard, the arrow keys, and WASD. With Shift they move sideways instead of turning. */
const MOTION_BY_KEY: Readonly<Record<string, Motion>> = {
  i: createMotion(1),
  o: createMotion(1, -1),
  j: createMotion(0, 1),
  l: createMotion(0, -1),
  u: createMotion(1, 1),
  ",": createMotion(-1),
  ".": createMotion(-1, 1),
  m: createMotion(-1, -1),
  I: createMotion(1),
  O: createMotion(1, 0, -1),
  J: createMotion(0, 0, 1),
  L: createMotion(0, 0, -1),
  U: createMotion(1, 0, 1),
  "<": createMotion(-1),
  ">": createMotion(-1, 0, -1),
  M: createMotion(-1, 0, 1),
  t: createMotion(0, 0, 0, 1),
  b: createMotion(0, 0, 0, -1),
  w: createMotion(1),
  s: createMotion(-1),
  a: createMotion(0, 1),
  d: createMotion(0, -1),
  W: createMotion(1),
  S: createMotion(-1),
  A: createMotion(0, 0, 1),
  D: createMotion(0, 0, -1),
  ArrowUp: createMotion(1),
  ArrowDown: createMotion(-1),
  ArrowLeft: createMotion(0, 1),
  ArrowRight: createMotion(0, -1),
};

const SIDEWAYS_ARROWS: Readonly<Record<string, Motion>> = { ArrowLeft: createMotion(0, 0, 1), ArrowRight: createMotion(0, 0, -1) };

/** Returns the motion of a key; null for other keys. */
export function motionOfKey(key: string, isShiftDown: boolean): Motion | null {
  return (isShiftDown ? SIDEWAYS_ARROWS[key] : undefined) ?? MOTION_BY_KEY[key] ?? null;
}

/** Returns the sum of several motions, clamped to -1 to 1. */
export function sumMotions(motions: Iterable<Motion>): Motion {
  const sum = { ...NO_MOTION };
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
