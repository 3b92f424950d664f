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
  private heldFocus: Focus | null = null;

  constructor(private readonly context: ToolContext) {
    this.camera = new MoveCameraTool(context);
  }

  activate(): void {
    this.camera.activate();
    this.setInteraction(true, false);
  }

  deactivate(): void {
    this.focus = this.heldFocus = null;
    this.camera.deactivate();
    this.setInteraction(false, false);
  }

  onPointer(event: ToolEvent): void {
    const isPressed = event.left || event.middle || event.right;
    if (this.heldFocus) {
      if (event.type !== "leave") this.send(event.type, event, this.heldFocus);
      if (event.type === "up" && !isPressed) this.release(event);
      return;
    }
    // A button pressed outside objects moves the camera, even when the pointer moves over an object.
    const isFree = event.type === "down" || event.type === "wheel" || !isPressed;
    if (isFree) this.updateFocus(event);
    const { focus } = this;
    const isOffered = isFree && event.type !== "up" && event.type !== "leave";
    if (!focus || !isOffered || !this.send(event.type, event, focus)) this.camera.onPointer(event);
    else if (event.type === "down") this.hold(focus);
  }

  private hold(focus: Focus): void {
    this.heldFocus = focus;
    this.setInteraction(true, this.context.state?.rows.bool(true, "Hide Inactive Objects") === true);
  }

  private release(event: ToolEvent): void {
    this.heldFocus = null;
    this.setInteraction(true, false);
    this.updateFocus(event);
  }

  /** Finds the object under the pointer, and notifies drawings when the pointer enters or leaves their objects. */
  private updateFocus(event: ToolEvent): void {
    const { stage } = this.context;
    const picked = event.type !== "leave" && stage.isInteractive ? stage.picker.objectAt(event.x, event.y) : null;
    const next = picked?.drawing.onPointer ? picked : null;
    const previousFocus = this.focus;
    this.focus = next;
    if (previousFocus && (previousFocus.drawing !== next?.drawing || previousFocus.hit.key !== next.hit.key)) {
      this.send("leave", event, previousFocus);
      if (next) this.send("enter", event, next);
    } else if (next && !previousFocus) this.send("enter", event, next);
  }

  private send(type: ScenePointer["type"], event: ToolEvent, { drawing, hit }: Focus): boolean {
    const { context } = this;
    const ray = context.stage.picker.rayAt(event.x, event.y);
    const setCursor = (cursor: string): void => context.setCursor(cursor);
    const setHint = (hint: string): void => context.setHint(hint);
    return drawing.onPointer?.({ ...event, type, ray, hit, setCursor, setHint }) ?? false;
  }

  private setInteraction(isEnabled: boolean, hidesOthers: boolean): void {
    this.context.stage.setInteraction({ isEnabled, hidesOthers });
  }
}
