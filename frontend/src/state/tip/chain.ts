import type { JointControl, JointDetails } from "../../protocol";
import type { DescriptionModel } from "../description-model";
import { composePoses, type PoseNumbers } from "../pose-numbers";

/** A joint of a chain, with the variable that moves it: its position is `multiplier` × the variable + `offset`. */
interface ChainJoint {
  readonly origin: PoseNumbers;
  readonly axis: readonly number[];
  readonly isPrismatic: boolean;
  /** The index of the variable; -1 for a fixed joint. */
  readonly variable: number;
  readonly multiplier: number;
  readonly offset: number;
}

/** A joint that a chain moves, rad or m. */
export interface ChainVariable {
  readonly name: string;
  readonly lower: number;
  readonly upper: number;
  /** Whether the joint turns without limits. */
  readonly isEndless: boolean;
}

/** The tip's pose in the base, and the columns of its Jacobian in the base: linear, then angular velocity. */
export interface TipMotion {
  readonly pose: PoseNumbers;
  readonly jacobian: readonly (readonly number[])[];
}

/** The joints between a base link and a tip link. Mimic joints move with the joint that they follow. */
export class Chain {
  private constructor(
    readonly base: string,
    readonly tip: string,
    readonly variables: readonly ChainVariable[],
    private readonly joints: readonly ChainJoint[],
  ) {}

  /**
   * Returns the chain from a base to a tip. Without a base, the chain reaches up to the topmost joint that moves, but
   * not beyond a joint without a slider, such as a floating joint.
   */
  static create(model: DescriptionModel, controls: readonly JointControl[], tip: string, base: string | null): Chain | null {
    const details = listJointsAbove(model, controls, tip, base);
    const variables: ChainVariable[] = [];
    const joints: ChainJoint[] = [];
    for (const joint of details) {
      const leader = joint.kind === "fixed" ? null : findLeader(controls, joint.name);
      let variable = -1;
      if (leader) {
        const range = intersectRanges(leader.control, joint, leader.multiplier, leader.offset);
        variable = variables.findIndex(({ name }) => name === leader.control.name);
        const previous = variables[variable];
        if (previous) variables[variable] = { ...previous, lower: Math.max(previous.lower, range.lower), upper: Math.min(previous.upper, range.upper) };
        else variable = variables.push({ name: leader.control.name, ...range, isEndless: leader.control.kind === "continuous" && leader.multiplier === 1 }) - 1;
      }
      joints.push({
        origin: [...joint.xyz, ...joint.quaternion] as unknown as PoseNumbers,
        axis: joint.axis,
        isPrismatic: joint.kind === "prismatic",
        variable,
        multiplier: leader?.multiplier ?? 0,
        offset: leader?.offset ?? 0,
      });
    }
    const [first] = details;
    return first && variables.length > 0 ? new Chain(first.parent, tip, variables, joints) : null;
  }

  /** Returns the tip's pose and its Jacobian for positions of the variables. */
  computeMotion(positions: readonly number[]): TipMotion {
    let pose: PoseNumbers = [0, 0, 0, 0, 0, 0, 1];
    const screws: { variable: number; axis: readonly number[]; point: readonly number[] | null }[] = [];
    for (const joint of this.joints) {
      pose = composePoses(pose, joint.origin);
      if (joint.variable < 0) continue;
      const value = joint.multiplier * (positions[joint.variable] ?? 0) + joint.offset;
      const [x = 0, y = 0, z = 0] = joint.axis;
      const direction = composePoses([0, 0, 0, pose[3], pose[4], pose[5], pose[6]], [x, y, z, 0, 0, 0, 1]);
      const axis = [direction[0], direction[1], direction[2]].map((component) => component * joint.multiplier);
      screws.push({ variable: joint.variable, axis, point: joint.isPrismatic ? null : [pose[0], pose[1], pose[2]] });
      const [sine, cosine] = [Math.sin(value / 2), Math.cos(value / 2)];
      pose = composePoses(pose, joint.isPrismatic ? [x * value, y * value, z * value, 0, 0, 0, 1] : [0, 0, 0, x * sine, y * sine, z * sine, cosine]);
    }
    const jacobian = this.variables.map(() => [0, 0, 0, 0, 0, 0]);
    for (const { variable, axis, point } of screws) {
      const [x = 0, y = 0, z = 0] = axis;
      const [px = 0, py = 0, pz = 0] = point ?? [];
      const [rx, ry, rz] = [pose[0] - px, pose[1] - py, pose[2] - pz];
      const column = point ? [y * rz - z * ry, z * rx - x * rz, x * ry - y * rx, x, y, z] : [x, y, z, 0, 0, 0];
      const sum = jacobian[variable];
      if (sum) column.forEach((component, i) => (sum[i] = (sum[i] ?? 0) + component));
    }
    return { pose, jacobian };
  }
}

/** Returns the links that can be the base of a chain to a tip: all above its lowest joint that moves. */
export function listBases(model: DescriptionModel, controls: readonly JointControl[], tip: string): string[] {
  const joints = listJointsAbove(model, controls, tip, null);
  const lowest = joints.findLastIndex(({ kind }) => kind !== "fixed");
  return joints.slice(0, lowest + 1).map(({ parent }) => parent);
}

/** Returns the joints from the base to the tip. */
function listJointsAbove(model: DescriptionModel, controls: readonly JointControl[], tip: string, base: string | null): JointDetails[] {
  const joints: JointDetails[] = [];
  for (let joint = model.parentJointOf(tip); joint && tip !== base; joint = model.parentJointOf(joint.parent)) {
    if (joint.kind !== "fixed" && !findLeader(controls, joint.name)) break;
    joints.unshift(joint);
    if (joint.parent === base) return joints;
  }
  const topmost = joints.findIndex(({ kind }) => kind !== "fixed");
  return topmost < 0 ? [] : joints.slice(topmost);
}

function findLeader(controls: readonly JointControl[], name: string): { control: JointControl; multiplier: number; offset: number } | null {
  let [multiplier, offset] = [1, 0];
  const visited = new Set<string>();
  for (let jointName = name; !visited.has(jointName); ) {
    visited.add(jointName);
    const control = controls.find((candidate) => candidate.name === jointName);
    if (!control) return null;
    if (control.mimic === null) return { control, multiplier, offset };
    offset += multiplier * control.offset;
    multiplier *= control.multiplier;
    jointName = control.mimic;
  }
  return null;
}

/** Returns the range of the leading joint in which the joint is within its own limits, if there is one. */
function intersectRanges({ lower, upper }: JointControl, joint: JointDetails, multiplier: number, offset: number): { lower: number; upper: number } {
  if (joint.lower === null || joint.upper === null || joint.kind === "continuous" || multiplier === 0) return { lower, upper };
  const ends = [(joint.lower - offset) / multiplier, (joint.upper - offset) / multiplier];
  const range = { lower: Math.max(lower, Math.min(...ends)), upper: Math.min(upper, Math.max(...ends)) };
  return range.lower <= range.upper ? range : { lower, upper };
}
