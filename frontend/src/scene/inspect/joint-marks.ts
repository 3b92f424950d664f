import { Matrix4, Vector3, type Object3D } from "three";
import type { JointDetails } from "../../protocol";
import { computeJointPose, type InspectedRobot } from "./inspected-robot";
import { VertexStream } from "./vertex-stream";

const AXIS_COLOR = 0xff9d3c;
const RANGE_COLOR = 0x35d0c0;
const POSITION_COLOR = 0xfff04d;
const BEYOND_LIMIT_COLOR = 0xff4d42;
const FAN_ALPHA = 0.16;
/** Sizes in units of the robot's mark size. */
const ARC_RADIUS = 0.5;
const AXIS_REACH = 0.65;
const STOP_SIZE = 0.09;
/** The angle between two points of an arc, rad. */
const ARC_STEP_RAD = Math.PI / 32;
/** A position may exceed a limit by this much and still count as within it. */
const LIMIT_TOLERANCE = 1e-4;

/** The axes of joints with arcs or rails between their limits, and the joints' positions. */
export class JointMarks {
  private readonly fans: VertexStream;
  private readonly lines: VertexStream;
  private shownJoints: { name: string; position: number | null; lower: number | null; upper: number | null }[] = [];

  constructor(parent: Object3D) {
    this.fans = new VertexStream(parent, "triangles");
    this.lines = new VertexStream(parent, "lines");
  }

  update(robots: readonly InspectedRobot[], isShown: boolean): void {
    this.fans.begin();
    this.lines.begin();
    this.shownJoints = [];
    for (const robot of isShown ? robots : []) {
      for (const joint of robot.model.joints.values()) this.addJoint(robot, joint);
    }
    this.fans.end();
    this.lines.end();
  }

  inspect(): object {
    return { joints: this.shownJoints.map((joint) => ({ ...joint })), vertices: this.lines.size };
  }

  private addJoint(robot: InspectedRobot, joint: JointDetails): void {
    const isMovable = joint.kind === "revolute" || joint.kind === "continuous" || joint.kind === "prismatic";
    const axis = new Vector3().fromArray(joint.axis);
    if (!isMovable || axis.lengthSq() === 0) return;
    const pose = new Matrix4();
    const position = computeJointPose(robot, joint, pose);
    if (position === null && !robot.frames.hasPose(robot.frames.rowOf(joint.parent))) return;
    const { name, lower, upper } = joint;
    this.shownJoints.push({ name, position, lower, upper });
    const axisLength = AXIS_REACH * robot.markSize;
    if (joint.kind === "prismatic") this.addRail(pose, axis, joint, position, robot.markSize);
    else {
      this.lines.setLook(AXIS_COLOR);
      this.lines.add(...[-axisLength, axisLength].map((distance) => axis.clone().multiplyScalar(distance).applyMatrix4(pose)));
      this.addArc(pose, axis, joint, position, robot.markSize);
    }
  }

  /** Draws an arc between the limits, or a circle without limits, and a pointer at the position. */
  private addArc(pose: Matrix4, axis: Vector3, joint: JointDetails, position: number | null, markSize: number): void {
    const [u, v] = perpendicularsOf(axis);
    const pointAt = (angle: number, radius: number): Vector3 =>
      new Vector3()
        .addScaledVector(u, radius * Math.cos(angle))
        .addScaledVector(v, radius * Math.sin(angle))
        .applyMatrix4(pose);
    const radius = ARC_RADIUS * markSize;
    const isLimited = joint.lower !== null && joint.upper !== null;
    const startAngle = isLimited ? (joint.lower ?? 0) : 0;
    // Limits may span several turns; draw one full circle at most.
    const endAngle = isLimited ? Math.min(joint.upper ?? 0, startAngle + 2 * Math.PI) : 2 * Math.PI;
    const center = new Vector3().setFromMatrixPosition(pose);
    const stepCount = Math.max(1, Math.ceil((endAngle - startAngle) / ARC_STEP_RAD));
    this.lines.setLook(RANGE_COLOR);
    this.fans.setLook(RANGE_COLOR, FAN_ALPHA);
    let previousPoint = pointAt(startAngle, radius);
    for (let i = 1; i <= stepCount; i++) {
      const nextPoint = pointAt(startAngle + ((endAngle - startAngle) * i) / stepCount, radius);
      this.lines.add(previousPoint, nextPoint);
      if (isLimited) this.fans.add(center, previousPoint, nextPoint);
      previousPoint = nextPoint;
    }
    if (isLimited) for (const limit of [joint.lower ?? 0, joint.upper ?? 0]) this.lines.add(center, pointAt(limit, radius * 1.12));
    if (position === null) return;
    this.lines.setLook(isBeyondLimit(joint, position) ? BEYOND_LIMIT_COLOR : POSITION_COLOR);
    this.lines.add(center, pointAt(position, radius * 1.2));
    this.fans.setLook(isBeyondLimit(joint, position) ? BEYOND_LIMIT_COLOR : POSITION_COLOR, 0.95);
    this.fans.add(pointAt(position, radius), pointAt(position - 0.07, radius * 1.2), pointAt(position + 0.07, radius * 1.2));
  }

  /** Draws a rail between the limits along the axis with stops at its ends, and a bead at the position. */
  private addRail(pose: Matrix4, axis: Vector3, joint: JointDetails, position: number | null, markSize: number): void {
    const [u, v] = perpendicularsOf(axis);
    const pointAt = (distance: number, x = 0, y = 0): Vector3 =>
      axis.clone().multiplyScalar(distance).addScaledVector(u, x).addScaledVector(v, y).applyMatrix4(pose);
    const { lower, upper } = joint;
    const stopSize = STOP_SIZE * markSize;
    if (lower !== null && upper !== null) {
      this.lines.setLook(RANGE_COLOR);
      this.lines.add(pointAt(lower), pointAt(upper));
      for (const stop of [lower, upper]) {
        this.lines.add(pointAt(stop, -stopSize), pointAt(stop, stopSize), pointAt(stop, 0, -stopSize), pointAt(stop, 0, stopSize));
      }
    }
    const axisLength = AXIS_REACH * markSize;
    this.lines.setLook(AXIS_COLOR, 0.8);
    this.lines.add(pointAt((lower ?? 0) - axisLength / 2), pointAt(lower ?? 0), pointAt(upper ?? 0), pointAt((upper ?? 0) + axisLength / 2));
    if (position === null) return;
    this.fans.setLook(isBeyondLimit(joint, position) ? BEYOND_LIMIT_COLOR : POSITION_COLOR, 0.95);
    const ring = [pointAt(position, stopSize), pointAt(position, 0, stopSize), pointAt(position, -stopSize), pointAt(position, 0, -stopSize)];
    const [frontPoint, backPoint] = [pointAt(position + stopSize), pointAt(position - stopSize)];
    ring.forEach((corner, i) => {
      const nextCorner = ring[(i + 1) % 4] ?? corner;
      this.fans.add(frontPoint, corner, nextCorner, backPoint, corner, nextCorner);
    });
  }
}

/**
 * Returns two directions perpendicular to an axis; angle 0 is along the first, which is the projection of the
 * coordinate axis farthest from the joint's axis.
 */
function perpendicularsOf(axis: Vector3): [Vector3, Vector3] {
  const components = axis.toArray().map(Math.abs);
  const helper = new Vector3().setComponent(components.indexOf(Math.min(...components)), 1);
  const u = helper.addScaledVector(axis, -helper.dot(axis)).normalize();
  return [u, new Vector3().crossVectors(axis, u)];
}

function isBeyondLimit({ lower, upper }: JointDetails, position: number): boolean {
  return (lower !== null && position < lower - LIMIT_TOLERANCE) || (upper !== null && position > upper + LIMIT_TOLERANCE);
}
