/** A direction of motion, components from -1 to 1: forward, left, up, and turning left. */
export interface Motion {
  x: number;
  y: number;
  z: number;
  turn: number;
}

export const STILL: Motion = { x: 0, y: 0, z: 0, turn: 0 };

const motion = (x: number, turn = 0, y = 0, z = 0): Motion => ({ x, y, z, turn });

/** The keys of teleop_twist_keyboard, the arrow keys, and WASD. With Shift they move sideways instead of turning. */
const KEYS: Readonly<Record<string, Motion>> = {
  i: motion(1),
  o: motion(1, -1),
  j: motion(0, 1),
  l: motion(0, -1),
  u: motion(1, 1),
  ",": motion(-1),
  ".": motion(-1, 1),
  m: motion(-1, -1),
  I: motion(1),
  O: motion(1, 0, -1),
  J: motion(0, 0, 1),
  L: motion(0, 0, -1),
  U: motion(1, 0, 1),
  "<": motion(-1),
  ">": motion(-1, 0, -1),
  M: motion(-1, 0, 1),
  t: motion(0, 0, 0, 1),
  b: motion(0, 0, 0, -1),
  w: motion(1),
  s: motion(-1),
  a: motion(0, 1),
  d: motion(0, -1),
  W: motion(1),
  S: motion(-1),
  A: motion(0, 0, 1),
  D: motion(0, 0, -1),
  ArrowUp: motion(1),
  ArrowDown: motion(-1),
  ArrowLeft: motion(0, 1),
  ArrowRight: motion(0, -1),
};

const SIDEWAYS: Readonly<Record<string, Motion>> = { ArrowLeft: motion(0, 0, 1), ArrowRight: motion(0, 0, -1) };

/** Returns the motion of a key; null for other keys. */
export function motionOfKey(key: string, shift: boolean): Motion | null {
  return (shift ? SIDEWAYS[key] : undefined) ?? KEYS[key] ?? null;
}

/** Returns the sum of several motions, clamped to -1 to 1. */
export function sumOf(motions: Iterable<Motion>): Motion {
  const sum = { ...STILL };
  for (const each of motions) {
    sum.x += each.x;
    sum.y += each.y;
    sum.z += each.z;
    sum.turn += each.turn;
  }
  return { x: clampToUnit(sum.x), y: clampToUnit(sum.y), z: clampToUnit(sum.z), turn: clampToUnit(sum.turn) };
}

export function isStill(each: Motion): boolean {
  return each.x === 0 && each.y === 0 && each.z === 0 && each.turn === 0;
}

/** Returns the deflection of a stick, -1 to 1, without the dead zone around its center. */
export function stickDeflection(value: number, play = 0.12): number {
  const beyond = Math.abs(value) - play;
  return beyond <= 0 ? 0 : clampToUnit((Math.sign(value) * beyond) / (1 - play));
}

function clampToUnit(value: number): number {
  return Math.min(1, Math.max(-1, value));
}
