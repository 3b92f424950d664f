import { Group, Matrix4 } from "three";
import { strings } from "../../strings";
import type { Vector } from "../../state/views/vector";
import { ArrowBatch, type ArrowShape } from "../objects/arrow-batch";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

const POSE_ARROW: ArrowShape = { shaftLength: 2, shaftDiameter: 0.2, headLength: 0.5, headDiameter: 0.35 };
const GREEN = 0x00ff00;

/**
 * RViz's 2D Pose Estimate and 2D Goal Pose: press at the position on the ground, drag in the direction of the
 * orientation, release.
 */
export class PoseTool implements SceneTool {
  private readonly root = new Group();
  private readonly arrow = new ArrowBatch(this.root);
  private position: Vector | null = null;
  private yaw = 0;

  constructor(private readonly context: ToolContext) {
    context.stage.viewport.scene.add(this.root);
  }

  activate(): void {
    this.context.setHint(strings.tools.hints.pose);
    this.context.setCursor("crosshair");
  }

  deactivate(): void {
    this.position = null;
    this.hide();
  }

  onPointer(event: ToolEvent): void {
    const { picker } = this.context.stage;
    if (event.type === "down" && event.button === "left") {
      this.position = picker.groundAt(event.x, event.y);
      this.yaw = 0;
    } else if (event.type === "move" && event.isLeftDown && this.position) {
      const target = picker.groundAt(event.x, event.y);
      if (target) this.aim(this.position, target);
    } else if (event.type === "up" && event.button === "left" && this.position) {
      this.send(this.position);
    }
  }

  inspect(): object {
    return { position: this.position, yaw: this.yaw, arrows: this.arrow.size };
  }

  dispose(): void {
    this.root.removeFromParent();
    this.arrow.dispose();
  }

  private aim(start: Vector, target: Vector): void {
    this.yaw = Math.atan2(target[1] - start[1], target[0] - start[0]);
    this.arrow.begin(1);
    this.arrow.add(new Matrix4().makeRotationZ(this.yaw).setPosition(...start), POSE_ARROW, { color: GREEN });
    this.arrow.end();
    this.context.stage.loop.invalidate();
  }

  private hide(): void {
    this.arrow.begin(0);
    this.arrow.end();
    this.context.stage.loop.invalidate();
  }

  private send([x, y]: Vector): void {
    const { session, state } = this.context;
    if (state) session.connection.send({ type: "pose_chosen", tool: state.id, x, y, yaw: this.yaw });
    this.context.finish();
  }
}
