import { strings } from "../../strings";
import { formatPoint } from "./point-text";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

/** RViz's Focus Camera: a click looks at the point under the pointer, or in its direction if there is none. */
export class FocusCameraTool implements SceneTool {
  constructor(private readonly context: ToolContext) {}

  activate(): void {
    this.context.setHint(strings.tools.hints.focusNowhere);
    this.context.setCursor("default");
  }

  onPointer(event: ToolEvent): void {
    if (event.type === "wheel" || event.type === "leave") return;
    const { stage, session } = this.context;
    const point = stage.picker.pointAt(event.x, event.y);
    this.context.setCursor(point ? "crosshair" : "default");
    this.context.setHint(point ? strings.tools.hints.focus(formatPoint(point)) : strings.tools.hints.focusNowhere);
    if (event.type !== "up" || event.button !== "left") return;
    const { origin, direction } = stage.picker.rayAt(event.x, event.y).ray;
    const target = origin.clone().add(direction);
    session.view.lookAt(point ?? [target.x, target.y, target.z]);
    this.context.finish();
  }
}
