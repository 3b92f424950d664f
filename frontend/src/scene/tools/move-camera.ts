import type { Motion } from "../../state/views/view-controller";
import { strings } from "../../strings";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

const CURSORS: Readonly<Record<Motion, string>> = {
  rotate3d: "grabbing",
  rotate2d: "grabbing",
  moveXY: "move",
  moveZ: "ns-resize",
  zoom: "zoom-in",
};

/** RViz's Move Camera: the mouse moves the camera as the view defines it, and a click selects a link. */
export class MoveCameraTool implements SceneTool {
  constructor(private readonly context: ToolContext) {}

  activate(): void {
    this.showHint(false);
    this.context.setCursor("default");
  }

  deactivate(): void {
    this.context.stage.isFocalShapeVisible = false;
  }

  onPointer(event: ToolEvent): void {
    const { stage, session } = this.context;
    const { view } = session;
    const isHeld = event.isLeftDown || event.isMiddleDown || event.isRightDown;
    this.showHint(event.isShiftDown);
    this.context.setCursor(isHeld ? CURSORS[view.controller.motionOf(event)] : "default");
    switch (event.type) {
      case "move":
        if (!isHeld) return;
        stage.isFocalShapeVisible = true;
        view.drag({ ...event, ...stage.viewport.size, x: event.x - event.dx, y: event.y - event.dy });
        return;
      case "wheel":
        view.handleWheel(event.wheel, event.isShiftDown);
        return;
      case "up":
        if (!isHeld) stage.isFocalShapeVisible = false;
        if (event.isClick && event.button === "left" && !event.isShiftDown) stage.picker.selectAt(event.x, event.y);
        return;
      case "down":
      case "leave":
    }
  }

  private showHint(isShiftDown: boolean): void {
    const { mouse } = strings.views;
    this.context.setHint(mouse[this.context.session.view.controller.hintFor(isShiftDown)]);
  }
}
