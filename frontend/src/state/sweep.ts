import type { JointControl } from "../protocol";

export type SweepOrder = "one" | "all";

/** Seconds in which a joint moves from its position to its upper limit, to its lower one and back, at speed 1. */
const ROUND_TRIP_S = 4;

/** Moves every joint through its range, one after another or all simultaneously, repeatedly. */
export class Sweep {
  private readonly joints: readonly JointControl[];

  /**
   * @param controls - the joints; those that mimic others are omitted.
   * @param startPositions - the positions of the joints, rad or m.
   */
  constructor(
    controls: readonly JointControl[],
    private readonly startPositions: Readonly<Record<string, number>>,
    private readonly order: SweepOrder,
  ) {
    this.joints = controls.filter((joint) => joint.mimic === null);
  }

  /** Returns the positions after this many seconds at speed 1; joints that are not moving have their start position. */
  positionsAt(seconds: number): Record<string, number> {
    const rounds = seconds / ROUND_TRIP_S;
    const movingIndex = Math.floor(rounds) % Math.max(1, this.joints.length);
    return Object.fromEntries(
      this.joints.map((joint, i) => {
        const startPosition = this.startPositions[joint.name] ?? joint.zero;
        const isMoving = this.order === "all" || i === movingIndex;
        return [joint.name, isMoving ? roundTripPosition(joint, startPosition, rounds % 1) : startPosition];
      }),
    );
  }
}

/**
 * Returns the position on the way from `start` to the upper limit, to the lower one and back; `progress` is the part of
 * the way, 0 to 1.
 */
export function roundTripPosition({ lower, upper }: Pick<JointControl, "lower" | "upper">, start: number, progress: number): number {
  const range = upper - lower;
  const distance = progress * 2 * range;
  const upwardLength = upper - start;
  if (distance <= upwardLength) return start + distance;
  if (distance <= upwardLength + range) return upper - (distance - upwardLength);
  return lower + (distance - upwardLength - range);
}
