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
  private readonly camera: MoveCameraTool;
  private readonly band = h("div", { class: "rubber-band" });
  private start: Vector2 | null = null;
  private isMovingCamera = false;

  constructor(private readonly context: ToolContext) {
    this.camera = new MoveCameraTool(context);
  }

  activate(): void {
    this.context.setHint(strings.tools.hints.select);
    this.context.setCursor("default");
  }

  deactivate(): void {
    this.endDrag();
    this.camera.deactivate();
  }

  onPointer(event: ToolEvent): void {
    if (event.type === "down") this.isMovingCamera = event.alt;
    if (this.isMovingCamera || event.type === "wheel") {
      this.camera.onPointer({ ...event, click: false });
      this.context.setHint(strings.tools.hints.select);
      return;
    }
    const { stage } = this.context;
    const pointer = new Vector2(event.x, event.y);
    if (event.type === "down" && event.button === "left") {
      this.start = pointer;
    } else if (event.type === "move" && this.start && event.left) {
      this.draw(this.start, pointer);
    } else if (event.type === "up" && event.button === "left" && this.start) {
      const mode: SelectionMode = event.shift ? "add" : event.ctrl ? "remove" : "replace";
      if (event.click) stage.picker.selectAt(event.x, event.y, mode);
      else stage.picker.selectBox(this.start, pointer, mode);
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

  private draw(a: Vector2, b: Vector2): void {
    const { style } = this.band;
    style.left = `${Math.min(a.x, b.x)}px`;
    style.top = `${Math.min(a.y, b.y)}px`;
    style.width = `${Math.abs(a.x - b.x)}px`;
    style.height = `${Math.abs(a.y - b.y)}px`;
    this.context.stage.viewport.container.append(this.band);
  }

  private endDrag(): void {
    this.start = null;
    this.band.remove();
  }
}
