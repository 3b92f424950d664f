import { Plane, Quaternion, Ray, Vector3 } from "three";
import type { InteractiveControl } from "../../protocol";

/** The pose of an interactive marker in its reference frame. */
export interface MarkerPose {
  position: Vector3;
  orientation: Quaternion;
}

/** A movement of the mouse; all vectors are in the marker's reference frame. */
export interface DragEvent {
  /** The ray from the camera through the pointer. */
  ray: Ray;
  /** The movement since the last event, pixels. */
  dx: number;
  dy: number;
  isShiftDown: boolean;
  isCtrlDown: boolean;
  /** The axes of the camera, unit vectors. */
  right: Vector3;
  up: Vector3;
  forward: Vector3;
}

const PIXELS_PER_TURN = 300;
/** Meters along the line of sight for each pixel and for each meter between the camera and the marker. */
const DEPTH_PER_PIXEL = 0.002;
/**
 * The minimum sine of the angle between a ray and a plane; at smaller angles the pointer gives no reliable position.
 */
const MIN_PLANE_SINE = 0.05;

/** A drag of an interactive marker's control, by the rules of RViz's InteractiveMarkerControl. */
export class Drag {
  private readonly startPose: MarkerPose;
  private readonly grabPoint: Vector3;
  /** The control's axis at the start of the drag: the direction of motion, or the axis of rotation. */
  private readonly axis: Vector3;
  private readonly pose: MarkerPose;

  /**
   * `grab` is the point where the control was grabbed, `orientation` the control's orientation, whose x axis is the
   * control's axis; both in the reference frame.
   */
  constructor(
    private readonly mode: InteractiveControl["mode"],
    startPose: MarkerPose,
    grab: Vector3,
    orientation: Quaternion,
  ) {
    this.startPose = copyPose(startPose);
    this.pose = copyPose(startPose);
    this.grabPoint = grab.clone();
    this.axis = new Vector3(1, 0, 0).applyQuaternion(orientation).normalize();
  }

  /** Returns the marker's pose after a movement of the mouse; null if the movement does not define one. */
  followPointer(event: DragEvent): MarkerPose | null {
    const hasMoved = this.applyMovement(event);
    return hasMoved ? copyPose(this.pose) : null;
  }

  private applyMovement(event: DragEvent): boolean {
    switch (this.mode) {
      case "move_axis":
        return this.moveAlongAxis(event.ray);
      case "move_plane":
        return this.moveInPlane(event.ray, this.axis);
      case "rotate_axis":
        return this.rotateAboutAxis(event.ray);
      case "move_rotate":
        return this.moveAndRotate(event.ray);
      case "move_3d":
        return this.moveFreely(event);
      case "rotate_3d":
        return this.rotateFreely(event);
      case "move_rotate_3d":
        return event.isCtrlDown ? this.rotateFreely(event) : this.moveFreely(event);
      case "none":
      case "menu":
      case "button":
        return false;
    }
  }

  private moveAlongAxis(ray: Ray): boolean {
    const distance = computeDistanceAlongAxis(ray, this.grabPoint, this.axis);
    if (distance === null) return false;
    this.pose.position.copy(this.startPose.position).addScaledVector(this.axis, distance);
    return true;
  }

  private moveInPlane(ray: Ray, normal: Vector3): boolean {
    const point = intersectPlane(ray, this.grabPoint, normal);
    if (!point) return false;
    this.pose.position.copy(point).sub(this.grabPoint).add(this.startPose.position);
    return true;
  }

  private rotateAboutAxis(ray: Ray): boolean {
    const center = this.findNearestOnAxis(this.startPose.position);
    const point = intersectPlane(ray, center, this.axis);
    if (!point) return false;
    const rotation = computeRotationBetween(this.grabPoint.clone().sub(center), point.sub(center), this.axis);
    this.pose.orientation.copy(rotation).multiply(this.startPose.orientation);
    return true;
  }

  /** Moves and turns the marker like a cart on a string: the grabbed point follows the mouse. */
  private moveAndRotate(ray: Ray): boolean {
    const center = this.findNearestOnAxis(this.pose.position);
    const point = intersectPlane(ray, center, this.axis);
    if (!point) return false;
    const arm = this.grabPoint.clone().sub(center);
    const offset = point.clone().sub(center);
    const distance = offset.length();
    if (distance === 0) return false;
    this.pose.orientation.premultiply(computeRotationBetween(arm, offset, this.axis));
    this.pose.position.addScaledVector(offset, (distance - arm.length()) / distance);
    this.grabPoint.copy(point);
    return true;
  }

  private moveFreely(event: DragEvent): boolean {
    if (!event.isShiftDown) return this.moveInPlane(event.ray, event.forward);
    const distance = event.ray.origin.distanceTo(this.pose.position);
    const step = -pickLarger(-event.dx, event.dy) * DEPTH_PER_PIXEL * distance;
    for (const point of [this.pose.position, this.startPose.position, this.grabPoint]) {
      point.addScaledVector(event.ray.direction, step);
    }
    return true;
  }

  private rotateFreely(event: DragEvent): boolean {
    const angleOf = (pixels: number): number => (pixels / PIXELS_PER_TURN) * 2 * Math.PI;
    const rotation = new Quaternion();
    if (event.isShiftDown) rotation.setFromAxisAngle(event.forward, angleOf(pickLarger(event.dx, event.dy)));
    else {
      rotation.setFromAxisAngle(event.up, angleOf(event.dx));
      rotation.multiply(new Quaternion().setFromAxisAngle(event.right, angleOf(event.dy)));
    }
    this.pose.orientation.premultiply(rotation);
    return true;
  }

  /** Returns the point of the axis through `origin` that is nearest to the grabbed point. */
  private findNearestOnAxis(origin: Vector3): Vector3 {
    const distance = this.grabPoint.clone().sub(origin).dot(this.axis);
    return origin.clone().addScaledVector(this.axis, distance);
  }
}

function copyPose(pose: MarkerPose): MarkerPose {
  return { position: pose.position.clone(), orientation: pose.orientation.clone() };
}

/** Returns the distance along the axis through `origin` to the point nearest to the ray; null if they are parallel. */
export function computeDistanceAlongAxis(ray: Ray, origin: Vector3, axis: Vector3): number | null {
  const offset = origin.clone().sub(ray.origin);
  const cosine = axis.dot(ray.direction);
  const sineSquared = 1 - cosine * cosine;
  if (sineSquared < 1e-6) return null;
  return (cosine * offset.dot(ray.direction) - offset.dot(axis)) / sineSquared;
}

function intersectPlane(ray: Ray, point: Vector3, normal: Vector3): Vector3 | null {
  if (Math.abs(normal.dot(ray.direction)) < MIN_PLANE_SINE) return null;
  return ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, point), new Vector3());
}

/** Returns the rotation about `axis` from the direction `start` to the direction `end`. */
export function computeRotationBetween(start: Vector3, end: Vector3, axis: Vector3): Quaternion {
  const [startInPlane, endInPlane] = [start, end].map((direction) => direction.clone().projectOnPlane(axis));
  if (!startInPlane || !endInPlane) return new Quaternion();
  const angle = Math.atan2(axis.dot(startInPlane.clone().cross(endInPlane)), startInPlane.dot(endInPlane));
  return new Quaternion().setFromAxisAngle(axis, angle);
}

function pickLarger(a: number, b: number): number {
  return Math.abs(a) > Math.abs(b) ? a : b;
}
