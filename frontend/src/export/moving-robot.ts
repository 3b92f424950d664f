import { Matrix4, Quaternion, Vector3 } from "three";
import type { Transforms } from "../connection/transforms";
import type { FrameTable, JointControl, JointScene, RobotScene } from "../protocol";

type Positions = Readonly<Record<string, number>>;

const MAX_MIMIC_DEPTH = 64;

/**
 * A frame with a parent: its fixed pose in the parent, or the joint that moves it, and the joint that leads that joint.
 */
interface Frame {
  readonly parent: number;
  readonly fixedPose: Matrix4;
  readonly joint: JointScene | null;
  readonly leader: string;
}

/**
 * A robot whose joints follow joints of another robot; `joints` maps its joint names to the names of the leading
 * joints.
 */
export interface FollowingRobot {
  readonly robot: RobotScene;
  readonly joints: Readonly<Record<string, string>>;
}

/**
 * The frames of an exported page. The frames of the robot follow its joints; all others keep their pose in their
 * parent.
 */
export class MovingRobot {
  private readonly frames: Frame[];
  private readonly parentsFirst: readonly number[];
  private readonly fixedFrame: { row: number; pose: Matrix4 };

  constructor(
    private readonly table: FrameTable,
    recordedTransforms: Transforms,
    robot: RobotScene,
    private readonly controls: readonly JointControl[],
    followers: readonly FollowingRobot[] = [],
  ) {
    const poses = table.names.map((_, row) => poseAt(recordedTransforms.poses, row));
    const identityMap = Object.fromEntries(robot.joints.map(({ name }) => [name, name]));
    const drivenJoints = new Map([{ robot, joints: identityMap }, ...followers].flatMap(findDrivenFrames));
    this.frames = table.names.map((name, row) => {
      const parent = table.parents[row] ?? -1;
      const pose = poses[row] ?? null;
      const parentPose = poses[parent] ?? null;
      const drivenJoint = drivenJoints.get(name);
      const joint = drivenJoint && drivenJoint.parentFrame === table.names[parent] ? drivenJoint.joint : null;
      const fixedPose = pose && parentPose ? parentPose.clone().invert().multiply(pose) : (pose?.clone() ?? new Matrix4());
      return { parent, fixedPose, joint, leader: drivenJoint?.leader ?? "" };
    });
    this.parentsFirst = sortParentsFirst(this.frames);
    // The fixed frame must not move, wherever it is in the tree. It is the frame whose recorded pose is the identity.
    const row = Math.max(0, poses.findIndex((pose) => pose !== null && isIdentity(pose)));
    this.fixedFrame = { row, pose: poses[row]?.clone() ?? new Matrix4() };
  }

  /** Returns the transforms of all frames for joint positions, rad or m. */
  computeTransforms(positions: Positions): Transforms {
    const poses = this.frames.map(() => new Matrix4());
    for (const row of this.parentsFirst) {
      const { parent, fixedPose, joint, leader } = this.frames[row] as Frame;
      const local = joint ? computeJointPose(joint, this.computePosition(leader, positions)) : fixedPose;
      const parentPose = poses[parent];
      poses[row]?.copy(local);
      if (parentPose) poses[row]?.premultiply(parentPose);
    }
    const shift = this.fixedFrame.pose.clone().multiply((poses[this.fixedFrame.row] ?? new Matrix4()).clone().invert());
    const poseNumbers = new Float32Array(poses.length * 7);
    const [translation, rotation, scale] = [new Vector3(), new Quaternion(), new Vector3()];
    poses.forEach((pose, row) => {
      pose.premultiply(shift).decompose(translation, rotation, scale);
      poseNumbers.set([...translation.toArray(), ...rotation.toArray()], row * 7);
    });
    return { revision: this.table.revision, stamp: 0, poses: poseNumbers, ages: new Float32Array(poses.length) };
  }

  /** Returns the position of a joint, also of one that mimics another. */
  computePosition(name: string, positions: Positions): number {
    let [factor, offset, leader] = [1, 0, name];
    for (let i = 0; i < MAX_MIMIC_DEPTH; i++) {
      const control = this.controls.find((jointControl) => jointControl.name === leader);
      if (!control || control.mimic === null) break;
      offset += factor * control.offset;
      factor *= control.multiplier;
      leader = control.mimic;
    }
    return (positions[leader] ?? 0) * factor + offset;
  }
}

/** Returns the frames that a robot's joints move, each with its joint, its parent frame and the leading joint. */
function findDrivenFrames({ robot, joints }: FollowingRobot): [string, { joint: JointScene; parentFrame: string | undefined; leader: string }][] {
  const frameByLink = new Map(robot.links.map(({ name, frame }) => [name, frame]));
  return robot.joints.flatMap((joint) => {
    const [frame, leader] = [frameByLink.get(joint.child), joints[joint.name]];
    if (frame === undefined || leader === undefined || joint.kind === "floating") return [];
    return [[frame, { joint, parentFrame: frameByLink.get(joint.parent), leader }]];
  });
}

/** Returns the pose of a joint's child link in its parent link. */
export function computeJointPose(joint: JointScene, position: number): Matrix4 {
  const origin = new Matrix4().compose(
    new Vector3().fromArray(joint.position),
    new Quaternion().fromArray(joint.quaternion),
    new Vector3(1, 1, 1),
  );
  const axis = new Vector3().fromArray(joint.axis);
  if (axis.lengthSq() === 0) return origin;
  axis.normalize();
  if (joint.kind === "prismatic") return origin.multiply(new Matrix4().makeTranslation(axis.multiplyScalar(position)));
  if (joint.kind !== "revolute" && joint.kind !== "continuous") return origin;
  return origin.multiply(new Matrix4().makeRotationAxis(axis, position));
}

function poseAt(poses: Float32Array, row: number): Matrix4 | null {
  const numbers = [...poses.subarray(row * 7, row * 7 + 7)];
  if (numbers.length < 7 || numbers.some(Number.isNaN)) return null;
  return new Matrix4().compose(
    new Vector3().fromArray(numbers),
    new Quaternion().fromArray(numbers, 3),
    new Vector3(1, 1, 1),
  );
}

function isIdentity(pose: Matrix4): boolean {
  const identity = new Matrix4();
  return pose.elements.every((element, i) => Math.abs(element - (identity.elements[i] ?? 0)) < 1e-6);
}

function sortParentsFirst(frames: readonly Frame[]): number[] {
  const order: number[] = [];
  const visitedRows = new Set<number>();
  const visit = (row: number): void => {
    if (visitedRows.has(row)) return;
    visitedRows.add(row);
    const parent = frames[row]?.parent ?? -1;
    if (parent >= 0) visit(parent);
    order.push(row);
  };
  frames.forEach((_, row) => visit(row));
  return order;
}
