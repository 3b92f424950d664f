import { Group, Matrix4, Quaternion, Ray, Vector3, type Camera, type Raycaster, type Sprite } from "three";
import type { DisplayData } from "../../connection/data";
import type { InteractiveMarkerShape, MarkerFeedback } from "../../protocol";
import type { FrameStore } from "../../state/frames";
import { createTextSprite } from "../markers/text-sprite";
import type { MeshLibrary } from "../meshes/mesh-library";
import { AxesBatch } from "../objects/axes-batch";
import type { ScenePointer } from "../picking";
import { readDataPose } from "../pose";
import { ControlHandle } from "./control-handle";
import { Drag, type MarkerPose } from "./dragging";
import { VisualAid } from "./visual-aid";

const AXES_LENGTH = 1;
const AXES_RADIUS = 0.05;
/**
 * The height of a description's letters, and the height of the description above the marker, relative to the marker's
 * scale.
 */
const TITLE_HEIGHT = 0.15;
const TITLE_OFFSET = 1.4;

/** The display's options. */
export interface MarkerOptions {
  showsDescriptions: boolean;
  showsAxes: boolean;
  /** Whether to show the line along which a control is dragged, or about which it is turned. */
  showsAids: boolean;
  /** Whether the Interact tool is active, so that controls which are not always visible are shown. */
  isInteractive: boolean;
}

/** An interactive marker: its controls, its title, and the drag in progress. */
export class MarkerHandle {
  readonly root = new Group();
  readonly controls: readonly ControlHandle[];
  private readonly frame = new Group();
  private readonly axes: AxesBatch;
  private readonly aid = new VisualAid(this.frame);
  private readonly title: Sprite | null;
  private readonly pose: MarkerPose = { position: new Vector3(), orientation: new Quaternion() };
  private drag: { drag: Drag; control: ControlHandle } | null = null;
  private grabPoint: Vector3 | null = null;

  constructor(
    readonly shape: InteractiveMarkerShape,
    private data: DisplayData,
    meshes: MeshLibrary,
    onChanged: () => void,
  ) {
    this.root.add(this.frame);
    this.frame.matrixAutoUpdate = false;
    this.controls = shape.controls.map((control) => new ControlHandle(control, meshes, onChanged));
    for (const control of this.controls) this.frame.add(control.root);
    this.axes = new AxesBatch(this.frame, AXES_LENGTH * shape.scale, AXES_RADIUS * shape.scale);
    const letterHeight = TITLE_HEIGHT * shape.scale;
    this.title = shape.description === "" ? null : createTextSprite(shape.description, letterHeight, [1, 1, 1, 1]);
    if (this.title) this.frame.add(this.title);
    this.setPose(shape.pose);
  }

  get isHeld(): boolean {
    return this.drag !== null;
  }

  /** Whether the line of the dragged control is shown. */
  get isAidShown(): boolean {
    return this.aid.isShown;
  }

  get isSettled(): boolean {
    return this.controls.every((control) => control.isSettled);
  }

  /** The pose in the marker's frame, in the order of messages. */
  get values(): number[] {
    const { position, orientation } = this.pose;
    return [...position.toArray(), ...orientation.toArray()];
  }

  /** Applies a pose from the server, except while the user drags the marker. */
  setServerPose(data: DisplayData, pose: readonly number[]): void {
    this.data = data;
    if (!this.drag) this.setPose(pose);
  }

  /** Updates the poses of its objects; returns false if its frame has no transform. */
  update(frames: FrameStore, camera: Camera, options: MarkerOptions): boolean {
    const hasPose = readDataPose(frames, this.data, this.frame.matrix);
    this.root.visible = hasPose;
    if (!hasPose) return false;
    this.frame.matrixWorldNeedsUpdate = true;
    const { position, orientation } = this.pose;
    for (const control of this.controls) {
      control.updatePose(position, orientation, camera, this.frame.matrix);
      control.root.visible = control.control.always_visible || options.isInteractive;
    }
    this.axes.begin(1);
    if (options.showsAxes) this.axes.add(new Matrix4().compose(position, orientation, new Vector3(1, 1, 1)));
    this.axes.end();
    const heldControl = this.drag?.control;
    if (heldControl && options.showsAids) this.aid.show(heldControl.control, position, heldControl.orientation);
    else this.aid.hide();
    if (this.title) {
      this.title.visible = options.showsDescriptions;
      this.title.position.copy(position).add(new Vector3(0, 0, TITLE_OFFSET * this.shape.scale));
    }
    return true;
  }

  /** Returns the nearest control that a ray in the fixed frame hits. */
  findNearestHit(ray: Raycaster): { control: number; distance: number; point: Vector3 } | null {
    let nearestHit: { control: number; distance: number; point: Vector3 } | null = null;
    this.controls.forEach((control, index) => {
      const hit = control.isActive && control.root.visible ? control.intersect(ray) : null;
      if (hit && (nearestHit === null || hit.distance < nearestHit.distance)) {
        nearestHit = { control: index, distance: hit.distance, point: hit.point };
      }
    });
    return nearestHit;
  }

  /** Starts dragging a control at a point in the fixed frame. */
  grab(control: ControlHandle, point: Vector3): void {
    const localPoint = point.clone().applyMatrix4(this.computeInverseMatrix());
    this.grabPoint = localPoint;
    this.drag = { drag: new Drag(control.control.mode, this.pose, localPoint, control.orientation), control };
  }

  /** Follows the mouse; returns true if the marker moved. */
  followPointer(event: ScenePointer, camera: Camera): boolean {
    if (!this.drag) return false;
    const inverse = this.computeInverseMatrix();
    const ray = event.ray.ray.clone().applyMatrix4(inverse);
    const rotation = new Quaternion().setFromRotationMatrix(inverse.clone().multiply(camera.matrixWorld));
    const newPose = this.drag.drag.followPointer({
      ray: new Ray(ray.origin, ray.direction.normalize()),
      dx: event.dx,
      dy: event.dy,
      isShiftDown: event.isShiftDown,
      isCtrlDown: event.isCtrlDown,
      right: new Vector3(1, 0, 0).applyQuaternion(rotation),
      up: new Vector3(0, 1, 0).applyQuaternion(rotation),
      forward: new Vector3(0, 0, -1).applyQuaternion(rotation),
    });
    if (!newPose) return false;
    this.pose.position.copy(newPose.position);
    this.pose.orientation.copy(newPose.orientation);
    return true;
  }

  release(): void {
    this.drag = null;
  }

  /** Returns the feedback message for an event of a control. */
  createFeedback(control: ControlHandle, event: MarkerFeedback["event"], menuEntry = 0): MarkerFeedback {
    return {
      type: "marker_feedback",
      display: this.data.display,
      marker: this.shape.name,
      control: control.control.name,
      event,
      pose: this.values,
      menu_entry: menuEntry,
      mouse_point: this.grabPoint?.toArray() ?? [],
    };
  }

  dispose(): void {
    this.root.removeFromParent();
    for (const control of this.controls) control.dispose();
    this.axes.dispose();
    this.aid.dispose();
    this.title?.material.map?.dispose();
    this.title?.material.dispose();
  }

  private computeInverseMatrix(): Matrix4 {
    return this.frame.matrix.clone().invert();
  }

  private setPose(pose: readonly number[]): void {
    const [x = 0, y = 0, z = 0, qx = 0, qy = 0, qz = 0, qw = 1] = pose;
    this.pose.position.set(x, y, z);
    this.pose.orientation.set(qx, qy, qz, qw).normalize();
  }
}
