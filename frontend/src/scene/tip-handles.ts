import { Matrix4, Quaternion, Vector3 } from "three";
import type { FrameStore } from "../state/frames";
import type { PoseNumbers } from "../state/pose-numbers";
import type { TipDrag } from "../state/tip/tip-drag";
import { Gizmo } from "./modeling/gizmo";
import { setPoseMatrix } from "./pose";
import type { Stage } from "./stage";
import type { ToolEvent } from "./tools/tool";

/** The size of the rings, so that the arrows end inside them. */
const RING_SCALE = 1.5;

/** Handles on the selected link: arrows move it and rings turn it, and the joints above it follow. */
export class TipHandles {
  private readonly arrows: Gizmo;
  private readonly rings: Gizmo;
  private held: Gizmo | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly tipDrag: TipDrag,
    frames: FrameStore,
  ) {
    this.arrows = new Gizmo(stage);
    this.rings = new Gizmo(stage, RING_SCALE);
    const update = (): void => this.update();
    for (const signal of [tipDrag.changed, frames.posesChanged, frames.tableChanged]) signal.on(update);
    this.update();
  }

  /** Handles an event; returns false if it is left to others. */
  onPointer(event: ToolEvent): boolean {
    const { tipDrag } = this;
    if (this.held) {
      if (event.type === "move") this.drag(this.held, event);
      else if (event.type === "up" && event.button === "left") this.release(event);
      return true;
    }
    if (!tipDrag.chain) return false;
    const gizmos = [this.arrows, this.rings];
    if (event.type === "down" && event.button === "left") {
      const grabbed = gizmos.find((gizmo) => gizmo.grab(event));
      if (!grabbed) return false;
      this.held = grabbed;
      if (!tipDrag.hold()) this.release(event);
      return true;
    }
    if (event.type !== "move" || event.isLeftDown || event.isMiddleDown || event.isRightDown || !gizmos.some((gizmo) => gizmo.hover(event))) return false;
    this.stage.viewport.canvas.style.cursor = "grab";
    return true;
  }

  /** Returns the positions of the handles on the canvas, for tests. */
  inspect(): object {
    const [x, y, z] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0), new Vector3(0, 0, 1)];
    return { x: this.arrows.positionOf(x), y: this.arrows.positionOf(y), z: this.arrows.positionOf(z) };
  }

  private drag(gizmo: Gizmo, event: ToolEvent): void {
    gizmo.drag(event, { length: 0, angle: 0 });
    this.tipDrag.follow(toPoseNumbers(gizmo.pose), gizmo === this.arrows ? "move" : "turn");
    const other = gizmo === this.arrows ? this.rings : this.arrows;
    other.show(gizmo.pose, other === this.arrows ? "translate" : "rotate", "local");
  }

  private release(event: ToolEvent): void {
    this.held?.release(event);
    this.held = null;
    this.tipDrag.release();
    this.update();
  }

  /** Moves the handles to the tip, except while the user holds one. */
  private update(): void {
    const { tipDrag } = this;
    if (this.held && tipDrag.isHeld) return;
    const pose = tipDrag.chain ? tipDrag.tipPose : null;
    const matrix = pose && setPoseMatrix(pose, new Matrix4());
    this.arrows.show(matrix, "translate", "local");
    this.rings.show(matrix, "rotate", "local");
  }
}

function toPoseNumbers(matrix: Matrix4): PoseNumbers {
  const [position, rotation] = [new Vector3(), new Quaternion()];
  matrix.decompose(position, rotation, new Vector3());
  return [...position.toArray(), rotation.x, rotation.y, rotation.z, rotation.w];
}
