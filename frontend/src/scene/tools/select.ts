import { Vector2 } from "three";
import { h } from "../../dom";
import type { SelectionMode } from "../../state/selection";
import { strings } from "../../strings";
import { MoveCameraTool } from "./move-camera";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

/**
 * RViz's Select: click or drag a rectangle. Shift adds, Ctrl removes, Alt moves the camera, F looks at the selection.
 */
export class SelectTool implements SceneTool {
  readonly grabsKeys = true;
  private readonly cameraTool: MoveCameraTool;
  private readonly rubberBand = h("div", { class: "rubber-band" });
  private dragStart: Vector2 | null = null;
  private isMovingCamera = false;

  constructor(private readonly context: ToolContext) {
    this.cameraTool = new MoveCameraTool(context);
  }

  activate(): void {
    this.context.setHint(strings.tools.hints.select);
    this.context.setCursor("default");
  }

  deactivate(): void {
    this.endDrag();
    this.cameraTool.deactivate();
  }

  onPointer(event: ToolEvent): void {
    if (event.type === "down") this.isMovingCamera = event.isAltDown;
    if (this.isMovingCamera || event.type === "wheel") {
      this.cameraTool.onPointer({ ...event, isClick: false });
      this.context.setHint(strings.tools.hints.select);
      return;
    }
    const { stage } = this.context;
    const pointer = new Vector2(event.x, event.y);
    if (event.type === "down" && event.button === "left") {
      this.dragStart = pointer;
    } else if (event.type === "move" && this.dragStart && event.isLeftDown) {
      this.draw(this.dragStart, pointer);
    } else if (event.type === "up" && event.button === "left" && this.dragStart) {
      const mode: SelectionMode = event.isShiftDown ? "add" : event.isCtrlDown ? "remove" : "replace";
      if (event.isClick) stage.picker.selectAt(event.x, event.y, mode);
      else stage.picker.selectBox(this.dragStart, pointer, mode);
      this.endDrag();
    }
  }

  pressKey(key: string): boolean {
    if (key === "f") this.context.stage.focusSelected();
    return true;
  }

  dispose(): void {
    this.endDrag();
  }

  private draw(start: Vector2, end: Vector2): void {
    const { style } = this.rubberBand;
    style.left = `${Math.min(start.x, end.x)}px`;
    style.top = `${Math.min(start.y, end.y)}px`;
    style.width = `${Math.abs(start.x - end.x)}px`;
    style.height = `${Math.abs(start.y - end.y)}px`;
    this.context.stage.viewport.container.append(this.rubberBand);
  }

  private endDrag(): void {
    this.dragStart = null;
    this.rubberBand.remove();
  }
}
