import { Matrix4, Vector3, type Ray } from "three";
import type { JointDetails } from "../protocol";
import type { DescriptionModel } from "../state/description-model";
import type { Session } from "../state/session";
import { readFramePose } from "./pose";
import type { Stage } from "./stage";
import type { ToolEvent } from "./tools/tool";

/** The range of the search on each side of the previous angle, rad, and its number of steps. */
const SEARCH_RANGE_RAD = Math.PI / 2;
const STEP_COUNT = 48;
const REFINEMENT_COUNT = 24;
/** The tools whose left button may also drag links. */
const COMPATIBLE_TOOLS = ["rviz_default_plugins/Interact", "rviz_default_plugins/MoveCamera"];

/**
 * The joint being dragged: its axis and origin, and the grabbed point of its link, in the fixed frame at the start of
 * the drag.
 */
interface JointGrab {
  readonly joint: JointDetails;
  readonly axis: Vector3;
  readonly origin: Vector3;
  readonly grabPoint: Vector3;
  readonly startPosition: number;
  movement: number;
}

/**
 * Drags links: with Alt, or while the switch for dragging is on, pulling a link moves the nearest joint above it that
 * can be moved.
 */
export class JointDrag {
  private currentGrab: JointGrab | null = null;
  private hasRequestedAxes = false;
  private isHovering = false;

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {}

  /** Handles a mouse event; returns false if the event is left to the active tool. */
  onPointer(event: ToolEvent): boolean {
    if (this.currentGrab) {
      if (event.type === "move" && event.isLeftDown) this.pull(this.currentGrab, event);
      else if (event.type === "up" && !event.isLeftDown) this.release();
      return true;
    }
    const { joints, tools } = this.session;
    const isEnabled = joints.controls !== null && (event.isAltDown || joints.dragsWithoutAlt) && event.type !== "leave";
    if (!isEnabled || (tools.current && !COMPATIBLE_TOOLS.includes(tools.current.cls))) {
      this.stopHovering();
      return false;
    }
    this.requestAxes();
    if (event.type === "down" && event.button === "left" && !event.isShiftDown) return this.grab(event);
    if (event.type === "move" && !event.isLeftDown && !event.isMiddleDown && !event.isRightDown) return this.hover(event);
    return false;
  }

  /** Requests the joints' axes, which are part of the description. Pages that never drag do not need it. */
  private requestAxes(): void {
    if (!this.hasRequestedAxes) this.session.description.hold();
    this.hasRequestedAxes = true;
  }

  private hover(event: ToolEvent): boolean {
    const picked = this.findMovableJoint(event);
    this.isHovering = picked !== null;
    this.session.focus.setHovered(picked && { display: picked.model.display, kind: "joint", name: picked.joint.name });
    this.stage.viewport.canvas.style.cursor = picked ? "grab" : "default";
    return picked !== null;
  }

  private grab(event: ToolEvent): boolean {
    const picked = this.findMovableJoint(event);
    if (!picked) return false;
    const { model, joint, point } = picked;
    const { frames, joints } = this.session;
    const pose = new Matrix4();
    if (!readFramePose(frames, frames.rowOf(model.links.get(joint.child)?.frame ?? ""), pose)) return false;
    // A joint's axis is the same in its own frame and in the frame of its child link.
    const axis = new Vector3().fromArray(joint.axis).transformDirection(pose);
    const origin = new Vector3().setFromMatrixPosition(pose);
    this.currentGrab = { joint, axis, origin, grabPoint: point, startPosition: joints.positions[joint.name] ?? 0, movement: 0 };
    this.stage.viewport.canvas.style.cursor = "grabbing";
    return true;
  }

  private pull(grab: JointGrab, event: ToolEvent): void {
    const { ray } = this.stage.picker.rayAt(event.x, event.y);
    const { joint, axis, origin, grabPoint } = grab;
    grab.movement =
      joint.kind === "prismatic" ? computeSlideDistance(ray, axis, grabPoint) : computeTurnAngle(ray, axis, origin, grabPoint, grab.movement);
    const target = this.session.joints.findLeader(joint.name, grab.startPosition + grab.movement);
    if (!target) return;
    const { control, position } = target;
    this.session.joints.move({ [control.name]: Math.min(Math.max(position, control.lower), control.upper) });
  }

  private release(): void {
    this.currentGrab = null;
    this.isHovering = true;
    this.stopHovering();
  }

  private stopHovering(): void {
    if (!this.isHovering) return;
    this.isHovering = false;
    this.session.focus.setHovered(null);
    this.stage.viewport.canvas.style.cursor = "default";
  }

  /** Returns the nearest movable joint above the link under the pointer. */
  private findMovableJoint(event: ToolEvent): { model: DescriptionModel; joint: JointDetails; point: Vector3 } | null {
    const picked = this.stage.picker.objectAt(event.x, event.y);
    const model = picked && this.session.description.modelOf(picked.display);
    if (!model) return null;
    for (let joint = model.parentJointOf(picked.hit.key); joint; joint = model.parentJointOf(joint.parent)) {
      if (this.session.joints.findLeader(joint.name, 0)) return { model, joint, point: picked.hit.point.clone() };
    }
    return null;
  }
}

/** Returns the distance that a point must slide along an axis to come closest to a ray, m; 0 if they are parallel. */
export function computeSlideDistance(ray: Ray, axis: Vector3, grabPoint: Vector3): number {
  const offset = grabPoint.clone().sub(ray.origin);
  const cosine = axis.dot(ray.direction);
  const sineSquared = 1 - cosine * cosine;
  if (sineSquared < 1e-6) return 0;
  return (cosine * offset.dot(ray.direction) - offset.dot(axis)) / sineSquared;
}

/**
 * Returns the angle by which a point must turn about an axis to come closest to a ray, rad.
 *
 * The search starts at the previous angle, so that the point can turn more than once, and stays on its side of the
 * circle when the circle is seen edge-on, where both sides are equally close.
 */
export function computeTurnAngle(ray: Ray, axis: Vector3, origin: Vector3, grabPoint: Vector3, startAngle: number): number {
  const arm = grabPoint.clone().sub(origin);
  const point = new Vector3();
  const distanceAt = (angle: number): number =>
    ray.distanceSqToPoint(point.copy(arm).applyAxisAngle(axis, angle).add(origin));
  let bestAngle = startAngle;
  let minDistance = distanceAt(startAngle);
  for (let i = -STEP_COUNT; i <= STEP_COUNT; i++) {
    const angle = startAngle + (SEARCH_RANGE_RAD * i) / STEP_COUNT;
    const angleDistance = distanceAt(angle);
    if (angleDistance < minDistance) [bestAngle, minDistance] = [angle, angleDistance];
  }
  for (let i = 0, step = SEARCH_RANGE_RAD / STEP_COUNT; i < REFINEMENT_COUNT; i++, step /= 2) {
    for (const angle of [bestAngle - step, bestAngle + step]) {
      const angleDistance = distanceAt(angle);
      if (angleDistance < minDistance) [bestAngle, minDistance] = [angle, angleDistance];
    }
  }
  return bestAngle;
}
