import type { Drawing } from "../displays/drawing";
import type { Hit, ScenePointer } from "../picking";
import { MoveCameraTool } from "./move-camera";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

interface Focus {
  drawing: Drawing;
  hit: Hit;
}

/** RViz's Interact: moves objects that can be moved, or else the camera. */
export class InteractTool implements SceneTool {
  private readonly camera: MoveCameraTool;
  /** The object under the pointer, and the object being dragged. */
  private focus: Focus | null = null;
  private held: Focus | null = null;

  constructor(private readonly context: ToolContext) {
    this.camera = new MoveCameraTool(context);
  }

  activate(): void {
    this.camera.activate();
    this.setInteraction(true, false);
  }

  deactivate(): void {
    this.focus = this.held = null;
    this.camera.deactivate();
    this.setInteraction(false, false);
  }

  pointer(event: ToolEvent): void {
    const pressed = event.left || event.middle || event.right;
    if (this.held) {
      if (event.type !== "leave") this.send(event.type, event, this.held);
      if (event.type === "up" && !pressed) this.release(event);
      return;
    }
    // A button pressed outside objects moves the camera, even when the pointer moves over an object.
    const free = event.type === "down" || event.type === "wheel" || !pressed;
    if (free) this.refocus(event);
    const { focus } = this;
    const offered = free && event.type !== "up" && event.type !== "leave";
    if (!focus || !offered || !this.send(event.type, event, focus)) this.camera.pointer(event);
    else if (event.type === "down") this.hold(focus);
  }

  private hold(focus: Focus): void {
    this.held = focus;
    this.setInteraction(true, this.context.state?.rows.bool(true, "Hide Inactive Objects") === true);
  }

  private release(event: ToolEvent): void {
    this.held = null;
    this.setInteraction(true, false);
    this.refocus(event);
  }

  /** Finds the object under the pointer, and notifies drawings when the pointer enters or leaves their objects. */
  private refocus(event: ToolEvent): void {
    const { stage } = this.context;
    const found = event.type !== "leave" && stage.isInteractive ? stage.picker.objectAt(event.x, event.y) : null;
    const next = found?.drawing.pointer ? found : null;
    const before = this.focus;
    this.focus = next;
    if (before && (before.drawing !== next?.drawing || before.hit.key !== next.hit.key)) {
      this.send("leave", event, before);
      if (next) this.send("enter", event, next);
    } else if (next && !before) this.send("enter", event, next);
  }

  private send(type: ScenePointer["type"], event: ToolEvent, { drawing, hit }: Focus): boolean {
    const { context } = this;
    const ray = context.stage.picker.rayAt(event.x, event.y);
    const setCursor = (cursor: string): void => context.setCursor(cursor);
    const setHint = (hint: string): void => context.setHint(hint);
    return drawing.pointer?.({ ...event, type, ray, hit, setCursor, setHint }) ?? false;
  }

  private setInteraction(isEnabled: boolean, hidesOthers: boolean): void {
    this.context.stage.setInteraction({ isEnabled, hidesOthers });
  }
}
