import { Matrix4, Object3D, PerspectiveCamera, Vector3 } from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { GizmoMode } from "../../state/modeling/modeling";
import type { Stage } from "../stage";
import type { ToolEvent } from "../tools/tool";

/** The size of the handles, for a mouse and for fingers. */
const [MOUSE_SIZE, TOUCH_SIZE] = [0.9, 1.3];

/** The length of handles on the canvas, as three.js defines it. */
const HANDLE_LENGTH = 0.19;

/** Handles that move, rotate and scale a frame; they get pointer events from the stage. */
export class Gizmo {
  private readonly frame = new Object3D();
  private readonly controls: TransformControls;
  private readonly helper: Object3D;

  /** `scale` is the size relative to the handles of other tools. */
  constructor(
    private readonly stage: Stage,
    scale = 1,
  ) {
    this.controls = new TransformControls(stage.viewport.camera);
    this.controls.size = scale * (matchMedia("(pointer: coarse)").matches ? TOUCH_SIZE : MOUSE_SIZE);
    this.helper = this.controls.getHelper();
    stage.overlays.add(this.frame, this.helper);
    this.controls.addEventListener("change", () => stage.loop.invalidate());
  }

  get isHeld(): boolean {
    return this.controls.dragging;
  }

  /** The pose of the frame, without its scale. */
  get pose(): Matrix4 {
    return new Matrix4().compose(this.frame.position, this.frame.quaternion, new Vector3(1, 1, 1));
  }

  get scale(): readonly [number, number, number] {
    return this.frame.scale.toArray();
  }

  /** Shows the handles at a pose in the fixed frame, along its axes or those of the fixed frame; null hides them. */
  show(pose: Matrix4 | null, mode: GizmoMode, space: "world" | "local" = mode === "translate" ? "world" : "local"): void {
    if (pose === null) {
      this.controls.detach();
    } else {
      pose.decompose(this.frame.position, this.frame.quaternion, this.frame.scale);
      this.frame.scale.setScalar(1);
      this.controls.mode = mode;
      this.controls.space = space;
      this.controls.attach(this.frame);
    }
    this.stage.loop.invalidate();
  }

  /** Returns the position of an axis's arrow or ring on the canvas, pixels; for tests. */
  positionOf(axis: Vector3): { x: number; y: number } {
    const { camera, size } = this.stage.viewport;
    const fieldOfView = camera instanceof PerspectiveCamera ? (camera.fov * Math.PI) / 180 : 1;
    const cameraPosition = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const radius = HANDLE_LENGTH * this.frame.position.distanceTo(cameraPosition) * this.controls.size * Math.tan(fieldOfView / 2);
    const tip = axis.clone().multiplyScalar(radius).applyQuaternion(this.frame.quaternion).add(this.frame.position).project(camera);
    return { x: ((tip.x + 1) / 2) * size.width, y: ((1 - tip.y) / 2) * size.height };
  }

  /** Whether the pointer is over a handle. */
  hover(event: ToolEvent): boolean {
    this.controls.camera = this.stage.viewport.camera;
    this.controls.pointerHover(this.toPointerEvent(event, -1));
    return this.controls.axis !== null;
  }

  /** Grabs the handle under the pointer; returns false if there is none. */
  grab(event: ToolEvent): boolean {
    if (!this.hover(event)) return false;
    this.helper.updateMatrixWorld(true); // the plane of this handle
    this.controls.pointerDown(this.toPointerEvent(event, 0));
    return this.isHeld;
  }

  /** Drags the handle; the steps are in m and rad, 0 for none. */
  drag(event: ToolEvent, steps: { length: number; angle: number }): void {
    this.controls.translationSnap = steps.length || null;
    this.controls.rotationSnap = steps.angle || null;
    this.controls.pointerMove(this.toPointerEvent(event, -1));
  }

  release(event: ToolEvent): void {
    this.controls.pointerUp(this.toPointerEvent(event, 0));
  }

  /** Ends the drag and restores the frame. */
  cancel(): void {
    this.controls.reset();
    this.controls.pointerUp(null);
  }

  /** Returns the event for three.js's controls: the position from -1 to 1, and a button as browsers number them. */
  private toPointerEvent({ x, y }: ToolEvent, button: number): PointerEvent {
    const { width, height } = this.stage.viewport.size;
    return { x: (x / width) * 2 - 1, y: 1 - (y / height) * 2, button } as PointerEvent;
  }
}
