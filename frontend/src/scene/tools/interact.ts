import type { Drawing } from "../displays/drawing";
import type { Hit, ScenePointer } from "../picking";
import { MoveCameraTool } from "./move-camera";
import type { SceneTool, ToolContext, ToolEvent } from "./tool";

interface HoveredObject {
  drawing: Drawing;
  hit: Hit;
}

/** RViz's Interact: moves objects that can be moved, or else the camera. */
export class InteractTool implements SceneTool {
  private readonly cameraTool: MoveCameraTool;
  /** The object under the pointer, and the object being dragged. */
  private hoveredObject: HoveredObject | null = null;
  private heldObject: HoveredObject | null = null;

  constructor(private readonly context: ToolContext) {
    this.cameraTool = new MoveCameraTool(context);
  }

  activate(): void {
    this.cameraTool.activate();
    this.setInteraction(true, false);
  }

  deactivate(): void {
    this.hoveredObject = this.heldObject = null;
    this.cameraTool.deactivate();
    this.setInteraction(false, false);
  }

  onPointer(event: ToolEvent): void {
    const isPressed = event.isLeftDown || event.isMiddleDown || event.isRightDown;
    if (this.heldObject) {
      if (event.type !== "leave") this.send(event.type, event, this.heldObject);
      if (event.type === "up" && !isPressed) this.release(event);
      return;
    }
    // A button pressed outside objects moves the camera, even when the pointer moves over an object.
    const canHover = event.type === "down" || event.type === "wheel" || !isPressed;
    if (canHover) this.updateHovered(event);
    const { hoveredObject } = this;
    const isForObject = canHover && event.type !== "up" && event.type !== "leave";
    if (!hoveredObject || !isForObject || !this.send(event.type, event, hoveredObject)) this.cameraTool.onPointer(event);
    else if (event.type === "down") this.hold(hoveredObject);
  }

  private hold(hoveredObject: HoveredObject): void {
    this.heldObject = hoveredObject;
    this.setInteraction(true, this.context.state?.rows.bool(true, "Hide Inactive Objects") === true);
  }

  private release(event: ToolEvent): void {
    this.heldObject = null;
    this.setInteraction(true, false);
    this.updateHovered(event);
  }

  /** Finds the object under the pointer, and notifies drawings when the pointer enters or leaves their objects. */
  private updateHovered(event: ToolEvent): void {
    const { stage } = this.context;
    const picked = event.type !== "leave" && stage.isInteractive ? stage.picker.objectAt(event.x, event.y) : null;
    const newObject = picked?.drawing.onPointer ? picked : null;
    const previousObject = this.hoveredObject;
    this.hoveredObject = newObject;
    if (previousObject && (previousObject.drawing !== newObject?.drawing || previousObject.hit.key !== newObject.hit.key)) {
      this.send("leave", event, previousObject);
      if (newObject) this.send("enter", event, newObject);
    } else if (newObject && !previousObject) this.send("enter", event, newObject);
  }

  private send(type: ScenePointer["type"], event: ToolEvent, { drawing, hit }: HoveredObject): boolean {
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
