import { Matrix4, Vector3, type Ray } from "three";
import type { JointDetails } from "../protocol";
import type { DescriptionModel } from "../state/description-model";
import type { Session } from "../state/session";
import { framePose } from "./pose";
import type { Stage } from "./stage";
import type { ToolEvent } from "./tools/tool";

/** The angle is searched within this range on both sides of the last one, rad, in this many steps. */
const REACH = Math.PI / 2;
const STEPS = 48;
const REFINEMENTS = 24;
/** The tools whose left button may also drag links. */
const TOOLS = ["rviz_default_plugins/Interact", "rviz_default_plugins/MoveCamera"];

/**
 * The joint being dragged: its axis and origin, and the grabbed point of its link, in the fixed frame at the start of
 * the drag.
 */
interface JointGrab {
  readonly joint: JointDetails;
  readonly axis: Vector3;
  readonly origin: Vector3;
  readonly grabbed: Vector3;
  readonly start: number;
  moved: number;
}

/**
 * Drags links: with Alt, or while the switch for dragging is on, pulling a link moves the nearest joint above it that
 * can be moved.
 */
export class JointDrag {
  private grabbed: JointGrab | null = null;
  private hasAxes = false;
  private isHovering = false;

  constructor(
    private readonly stage: Stage,
    private readonly session: Session,
  ) {}

  /** Handles a mouse event; returns false if the event is left to the active tool. */
  pointer(event: ToolEvent): boolean {
    if (this.grabbed) {
      if (event.type === "move" && event.left) this.pull(this.grabbed, event);
      else if (event.type === "up" && !event.left) this.release();
      return true;
    }
    const { joints, tools } = this.session;
    const isEnabled = joints.controls !== null && (event.alt || joints.dragsWithoutAlt) && event.type !== "leave";
    if (!isEnabled || (tools.current && !TOOLS.includes(tools.current.cls))) {
      this.stopHovering();
      return false;
    }
    this.requestAxes();
    if (event.type === "down" && event.button === "left" && !event.shift) return this.grab(event);
    if (event.type === "move" && !event.left && !event.middle && !event.right) return this.hover(event);
    return false;
  }

  /** Requests the joints' axes, which are part of the description. Pages that never drag do not need it. */
  private requestAxes(): void {
    if (!this.hasAxes) this.session.description.hold();
    this.hasAxes = true;
  }

  private hover(event: ToolEvent): boolean {
    const found = this.find(event);
    this.isHovering = found !== null;
    this.session.focus.setHovered(found && { display: found.model.display, kind: "joint", name: found.joint.name });
    this.stage.viewport.canvas.style.cursor = found ? "grab" : "default";
    return found !== null;
  }

  private grab(event: ToolEvent): boolean {
    const found = this.find(event);
    if (!found) return false;
    const { model, joint, point } = found;
    const { frames, joints } = this.session;
    const pose = new Matrix4();
    if (!framePose(frames, frames.rowOf(model.links.get(joint.child)?.frame ?? ""), pose)) return false;
    // A joint's axis is the same in its own frame and in the frame of its child link.
    const axis = new Vector3().fromArray(joint.axis).transformDirection(pose);
    const origin = new Vector3().setFromMatrixPosition(pose);
    this.grabbed = { joint, axis, origin, grabbed: point, start: joints.positions[joint.name] ?? 0, moved: 0 };
    this.stage.viewport.canvas.style.cursor = "grabbing";
    return true;
  }

  private pull(hold: JointGrab, event: ToolEvent): void {
    const { ray } = this.stage.picker.rayAt(event.x, event.y);
    const { joint, axis, origin, grabbed } = hold;
    hold.moved =
      joint.kind === "prismatic" ? slideTowards(ray, axis, grabbed) : turnTowards(ray, axis, origin, grabbed, hold.moved);
    const target = this.session.joints.leaderOf(joint.name, hold.start + hold.moved);
    if (!target) return;
    const { control, position } = target;
    this.session.joints.move({ [control.name]: Math.min(Math.max(position, control.lower), control.upper) });
  }

  private release(): void {
    this.grabbed = null;
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
  private find(event: ToolEvent): { model: DescriptionModel; joint: JointDetails; point: Vector3 } | null {
    const found = this.stage.picker.objectAt(event.x, event.y);
    const model = found && this.session.description.modelOf(found.display);
    if (!model) return null;
    for (let joint = model.jointAbove(found.hit.key); joint; joint = model.jointAbove(joint.parent)) {
      if (this.session.joints.leaderOf(joint.name, 0)) return { model, joint, point: found.hit.point.clone() };
    }
    return null;
  }
}

/** Returns the distance that a point must slide along an axis to come closest to a ray, m; 0 if they are parallel. */
export function slideTowards(ray: Ray, axis: Vector3, grabbed: Vector3): number {
  const between = grabbed.clone().sub(ray.origin);
  const cosine = axis.dot(ray.direction);
  const across = 1 - cosine * cosine;
  if (across < 1e-6) return 0;
  return (cosine * between.dot(ray.direction) - between.dot(axis)) / across;
}

/**
 * Returns the angle by which a point must turn about an axis to come closest to a ray, rad.
 *
 * The search starts at the previous angle, so that the point can turn more than once, and stays on its side of the
 * circle when the circle is seen edge-on, where both sides are equally close.
 */
export function turnTowards(ray: Ray, axis: Vector3, origin: Vector3, grabbed: Vector3, before: number): number {
  const arm = grabbed.clone().sub(origin);
  const point = new Vector3();
  const distance = (angle: number): number =>
    ray.distanceSqToPoint(point.copy(arm).applyAxisAngle(axis, angle).add(origin));
  let best = before;
  let least = distance(before);
  for (let i = -STEPS; i <= STEPS; i++) {
    const angle = before + (REACH * i) / STEPS;
    const here = distance(angle);
    if (here < least) [best, least] = [angle, here];
  }
  for (let i = 0, step = REACH / STEPS; i < REFINEMENTS; i++, step /= 2) {
    for (const angle of [best - step, best + step]) {
      const here = distance(angle);
      if (here < least) [best, least] = [angle, here];
    }
  }
  return best;
}
