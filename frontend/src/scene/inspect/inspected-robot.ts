import { Matrix4, Quaternion, Vector3 } from "three";
import type { JointDetails } from "../../protocol";
import type { DescriptionModel } from "../../state/description-model";
import type { FrameStore } from "../../state/frames";
import { readFramePose } from "../pose";

/** A robot whose invisible properties are drawn. */
export interface InspectedRobot {
  readonly model: DescriptionModel;
  readonly frames: FrameStore;
  /** The mark size, m: a share of the robot's size. */
  readonly markSize: number;
  /** Links whose mass or inertia is implausible. */
  readonly implausibleLinks: ReadonlySet<string>;
  /** Joint positions that are known from other sources than transforms, rad or m. */
  readonly positions: Readonly<Record<string, number>>;
}

/** Computes the pose of a link in the fixed frame; returns false if it has none. */
export function computeLinkPose({ model, frames }: InspectedRobot, link: string, matrix: Matrix4): boolean {
  return readFramePose(frames, frames.rowOf(model.links.get(link)?.frame ?? ""), matrix);
}

const origin = new Matrix4();
const child = new Matrix4();
const jointPosition = new Vector3();
const jointRotation = new Quaternion();
const scale = new Vector3();

/**
 * Computes the frame of a joint at its zero position, in the fixed frame.
 *
 * @returns the position of the joint according to the transforms, rad or m; null if they do not contain it.
 */
export function computeJointPose(robot: InspectedRobot, joint: JointDetails, matrix: Matrix4): number | null {
  if (!computeLinkPose(robot, joint.parent, matrix)) return null;
  const [x = 0, y = 0, z = 0] = joint.xyz;
  const [qx = 0, qy = 0, qz = 0, qw = 1] = joint.quaternion;
  matrix.multiply(origin.compose(jointPosition.set(x, y, z), jointRotation.set(qx, qy, qz, qw), ONE));
  if (!computeLinkPose(robot, joint.child, child)) return null;
  child.premultiply(origin.copy(matrix).invert()).decompose(jointPosition, jointRotation, scale);
  const [ax = 0, ay = 0, az = 0] = joint.axis;
  if (joint.kind === "prismatic") return jointPosition.x * ax + jointPosition.y * ay + jointPosition.z * az;
  const angle = 2 * Math.atan2(jointRotation.x * ax + jointRotation.y * ay + jointRotation.z * az, jointRotation.w);
  const knownPosition = robot.positions[joint.name];
  // Transforms give angles only modulo whole turns.
  if (knownPosition !== undefined) return knownPosition;
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

const ONE = new Vector3(1, 1, 1);
