import { Matrix4, Vector3, type Object3D } from "three";
import type { JointDetails } from "../../protocol";
import { computeJointPose, type InspectedRobot } from "./inspected-robot";
import { VertexStream } from "./vertex-stream";

const AXIS = 0xff9d3c;
const RANGE = 0x35d0c0;
const CURRENT = 0xfff04d;
const BEYOND_LIMIT = 0xff4d42;
const FAN_ALPHA = 0.16;
/** Sizes in units of the robot's mark size. */
const RADIUS = 0.5;
const AXIS_REACH = 0.65;
const STOP_SIZE = 0.09;
/** The angle between two points of an arc, rad. */
const ARC_STEP = Math.PI / 32;
/** A position may exceed a limit by this much and still count as within it. */
const TOLERANCE = 1e-4;

/** The axes of joints with arcs or rails between their limits, and the joints' positions. */
export class JointMarks {
  private readonly fans: VertexStream;
  private readonly lines: VertexStream;
  private shownJoints: { name: string; position: number | null; lower: number | null; upper: number | null }[] = [];

  constructor(parent: Object3D) {
    this.fans = new VertexStream(parent, "triangles");
    this.lines = new VertexStream(parent, "lines");
  }

  update(robots: readonly InspectedRobot[], isWanted: boolean): void {
    this.fans.begin();
    this.lines.begin();
    this.shownJoints = [];
    for (const robot of isWanted ? robots : []) {
      for (const joint of robot.model.joints.values()) this.mark(robot, joint);
    }
    this.fans.end();
    this.lines.end();
  }

  inspect(): object {
    return { joints: this.shownJoints.map((joint) => ({ ...joint })), vertices: this.lines.size };
  }

  private mark(robot: InspectedRobot, joint: JointDetails): void {
    const isMovable = joint.kind === "revolute" || joint.kind === "continuous" || joint.kind === "prismatic";
    const axis = new Vector3().fromArray(joint.axis);
    if (!isMovable || axis.lengthSq() === 0) return;
    const pose = new Matrix4();
    const position = computeJointPose(robot, joint, pose);
    if (position === null && !robot.frames.has(robot.frames.rowOf(joint.parent))) return;
    const { name, lower, upper } = joint;
    this.shownJoints.push({ name, position, lower, upper });
    const axisLength = AXIS_REACH * robot.unit;
    if (joint.kind === "prismatic") this.addRail(pose, axis, joint, position, robot.unit);
    else {
      this.lines.setLook(AXIS);
      this.lines.add(...[-axisLength, axisLength].map((distance) => axis.clone().multiplyScalar(distance).applyMatrix4(pose)));
      this.addArc(pose, axis, joint, position, robot.unit);
    }
  }

  /** Draws an arc between the limits, or a circle without limits, and a pointer at the position. */
  private addArc(pose: Matrix4, axis: Vector3, joint: JointDetails, position: number | null, unit: number): void {
    const [u, v] = perpendicularsOf(axis);
    const point = (angle: number, radius: number): Vector3 =>
      new Vector3()
        .addScaledVector(u, radius * Math.cos(angle))
        .addScaledVector(v, radius * Math.sin(angle))
        .applyMatrix4(pose);
    const radius = RADIUS * unit;
    const isLimited = joint.lower !== null && joint.upper !== null;
    const startAngle = isLimited ? (joint.lower ?? 0) : 0;
    // Limits may span several turns; draw one full circle at most.
    const endAngle = isLimited ? Math.min(joint.upper ?? 0, startAngle + 2 * Math.PI) : 2 * Math.PI;
    const center = new Vector3().setFromMatrixPosition(pose);
    const steps = Math.max(1, Math.ceil((endAngle - startAngle) / ARC_STEP));
    this.lines.setLook(RANGE);
    this.fans.setLook(RANGE, FAN_ALPHA);
    let previousPoint = point(startAngle, radius);
    for (let i = 1; i <= steps; i++) {
      const next = point(startAngle + ((endAngle - startAngle) * i) / steps, radius);
      this.lines.add(previousPoint, next);
      if (isLimited) this.fans.add(center, previousPoint, next);
      previousPoint = next;
    }
    if (isLimited) for (const end of [joint.lower ?? 0, joint.upper ?? 0]) this.lines.add(center, point(end, radius * 1.12));
    if (position === null) return;
    this.lines.setLook(isBeyond(joint, position) ? BEYOND_LIMIT : CURRENT);
    this.lines.add(center, point(position, radius * 1.2));
    this.fans.setLook(isBeyond(joint, position) ? BEYOND_LIMIT : CURRENT, 0.95);
    this.fans.add(point(position, radius), point(position - 0.07, radius * 1.2), point(position + 0.07, radius * 1.2));
  }

  /** Draws a rail between the limits along the axis with stops at its ends, and a bead at the position. */
  private addRail(pose: Matrix4, axis: Vector3, joint: JointDetails, position: number | null, unit: number): void {
    const [u, v] = perpendicularsOf(axis);
    const point = (distance: number, x = 0, y = 0): Vector3 =>
      axis.clone().multiplyScalar(distance).addScaledVector(u, x).addScaledVector(v, y).applyMatrix4(pose);
    const { lower, upper } = joint;
    const end = STOP_SIZE * unit;
    if (lower !== null && upper !== null) {
      this.lines.setLook(RANGE);
      this.lines.add(point(lower), point(upper));
      for (const stop of [lower, upper]) {
        this.lines.add(point(stop, -end), point(stop, end), point(stop, 0, -end), point(stop, 0, end));
      }
    }
    const axisLength = AXIS_REACH * unit;
    this.lines.setLook(AXIS, 0.8);
    this.lines.add(point((lower ?? 0) - axisLength / 2), point(lower ?? 0), point(upper ?? 0), point((upper ?? 0) + axisLength / 2));
    if (position === null) return;
    this.fans.setLook(isBeyond(joint, position) ? BEYOND_LIMIT : CURRENT, 0.95);
    const ring = [point(position, end), point(position, 0, end), point(position, -end), point(position, 0, -end)];
    const [frontPoint, backPoint] = [point(position + end), point(position - end)];
    ring.forEach((corner, i) => {
      const next = ring[(i + 1) % 4] ?? corner;
      this.fans.add(frontPoint, corner, next, backPoint, corner, next);
    });
  }
}

/**
 * Returns two directions perpendicular to an axis; angle 0 is along the first, which is the projection of the
 * coordinate axis farthest from the joint's axis.
 */
function perpendicularsOf(axis: Vector3): [Vector3, Vector3] {
  const parts = axis.toArray().map(Math.abs);
  const helper = new Vector3().setComponent(parts.indexOf(Math.min(...parts)), 1);
  const u = helper.addScaledVector(axis, -helper.dot(axis)).normalize();
  return [u, new Vector3().crossVectors(axis, u)];
}

function isBeyond({ lower, upper }: JointDetails, position: number): boolean {
  return (lower !== null && position < lower - TOLERANCE) || (upper !== null && position > upper + TOLERANCE);
}
