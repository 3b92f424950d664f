import { strings } from "../../strings";
import { formatPoint } from "./point-text";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

/** RViz's Publish Point: publishes the clicked point of an object. */
export class PublishPointTool implements SceneTool {
  constructor(private readonly context: ToolContext) {}

  activate(): void {
    this.context.setHint(strings.tools.hints.pointNowhere);
    this.context.setCursor("default");
  }

  onPointer(event: ToolEvent): void {
    if (event.type === "wheel" || event.type === "leave") return;
    const { stage, session, state } = this.context;
    const point = stage.picker.pointAt(event.x, event.y);
    this.context.setCursor(point ? "crosshair" : "default");
    this.context.setHint(point ? strings.tools.hints.point(formatPoint(point)) : strings.tools.hints.pointNowhere);
    if (event.type !== "up" || event.button !== "left") return;
    if (!point && event.isClick) this.context.showNotice(strings.tools.hints.nothingThere);
    if (!point || !state) return;
    const [x, y, z] = point;
    session.connection.send({ type: "point_chosen", tool: state.id, x, y, z });
    if (state.rows.bool(true, "Single click")) this.context.finish();
  }
}
