import type { Object3D, Quaternion, Vector3 } from "three";
import type { InteractiveControl } from "../../protocol";
import { ThinLines } from "../objects/thin-lines";

/** The length of the line to each side, in meters. */
const HALF_LENGTH_M = 1000;
const MODES_WITH_LINE: ReadonlySet<InteractiveControl["mode"]> = new Set<InteractiveControl["mode"]>([
  "move_axis",
  "rotate_axis",
  "move_rotate",
]);

/** RViz's visual aid: the line along which a dragged control moves, or about which it turns. */
export class VisualAid {
  private line: ThinLines | null = null;

  constructor(private readonly parent: Object3D) {}

  get isShown(): boolean {
    return this.line !== null && this.line.root.parent !== null;
  }

  /** Shows the line of a control, if its mode has one; the x axis of `orientation` is the control's axis. */
  show(control: InteractiveControl, position: Vector3, orientation: Quaternion): void {
    this.hide();
    if (!MODES_WITH_LINE.has(control.mode) || control.orientation_mode === "view_facing") return;
    if (!this.line) {
      this.line = new ThinLines();
      this.line.setSegments(new Float32Array([-HALF_LENGTH_M, 0, 0, HALF_LENGTH_M, 0, 0]));
    }
    this.parent.add(this.line.root);
    this.line.root.position.copy(position);
    this.line.root.quaternion.copy(orientation);
  }

  hide(): void {
    this.line?.root.removeFromParent(); // an object that is only made invisible still counts toward the bounds
  }

  dispose(): void {
    this.line?.dispose();
  }
}
