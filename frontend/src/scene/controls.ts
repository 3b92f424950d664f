import type { ViewState } from "../state/view";
import { strings } from "../strings";
import type { Stage } from "./stage";
import type { PointerButton, ToolEvent } from "./tools/tool";

/** A press that moves less than this is a click, px. */
const CLICK_SLOP_PX = 4;
const WHEEL_LINE_PX = 40;
const KEY_STEP_PX = 20;
const WHEEL_NOTCH = 120;
/** The wheel delta per relative change of the fingers' distance, 1 - old distance / new distance. */
const PINCH_UNIT = 1000;
const BUTTON_NAMES: readonly PointerButton[] = ["left", "middle", "right"];

/** Converts input on the canvas by mouse, fingers and arrow keys into events for the active tool. */
export class Controls {
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private lastPosition = { x: 0, y: 0 };
  private travelledPx = 0;
  private isPointerOver = false;

  constructor(
    private readonly stage: Stage,
    private readonly view: ViewState,
    private readonly emit: (event: ToolEvent) => void,
  ) {
    const { canvas } = stage.viewport;
    canvas.tabIndex = 0;
    // With this role, screen readers pass its keys on and read out the list of keys.
    canvas.setAttribute("role", "application");
    canvas.setAttribute("aria-label", strings.scene.keys);
    canvas.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    canvas.addEventListener("pointermove", (event) => this.onPointerMove(event));
    canvas.addEventListener("pointerup", (event) => this.onPointerEnd(event, true));
    canvas.addEventListener("pointercancel", (event) => this.onPointerEnd(event, false));
    canvas.addEventListener("pointerleave", (event) => this.onPointerLeave(event));
    canvas.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("keydown", (event) => this.onKeyDown(event));
  }

  /** The position of the pointer over the canvas; null while the pointer is elsewhere. */
  get position(): { x: number; y: number } | null {
    return this.isPointerOver ? this.lastPosition : null;
  }

  private onPointerDown(event: PointerEvent): void {
    const { canvas } = this.stage.viewport;
    if (event.button === 1) event.preventDefault();
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.travelledPx = this.pointers.size > 1 ? CLICK_SLOP_PX : 0;
    this.isPointerOver = true;
    this.lastPosition = { x: event.offsetX, y: event.offsetY };
    this.emit(this.createToolEvent("down", event));
  }

  private onPointerMove(event: PointerEvent): void {
    const pointer = this.pointers.get(event.pointerId);
    const fingerDistance = this.measureFingerDistance();
    if (pointer) {
      this.travelledPx += Math.hypot(event.clientX - pointer.x, event.clientY - pointer.y);
      pointer.x = event.clientX;
      pointer.y = event.clientY;
    }
    const toolEvent = this.createToolEvent("move", event);
    this.isPointerOver = true;
    this.lastPosition = { x: event.offsetX, y: event.offsetY };
    if (toolEvent.dx === 0 && toolEvent.dy === 0) return;
    if (this.pointers.size > 1) this.pinch(toolEvent, fingerDistance);
    else this.emit(toolEvent);
  }

  /** Handles two fingers: each moves the view by half its motion, and a change of their distance zooms. */
  private pinch(event: ToolEvent, oldDistance: number): void {
    const { x, y, dx, dy } = event;
    const halfMotion = { dx: dx / 2, dy: dy / 2, x: x - dx, y: y - dy };
    this.view.drag({ ...this.stage.viewport.size, ...halfMotion, isLeftDown: false, isMiddleDown: true, isRightDown: false, isShiftDown: false });
    const newDistance = Math.max(1, this.measureFingerDistance());
    if (oldDistance > 0) this.view.handleWheel((1 - oldDistance / newDistance) * PINCH_UNIT, false);
  }

  private onPointerEnd(event: PointerEvent, isComplete: boolean): void {
    if (!this.pointers.delete(event.pointerId)) return;
    const isClick = isComplete && this.travelledPx < CLICK_SLOP_PX;
    this.emit({ ...this.createToolEvent("up", event), isClick });
  }

  private onPointerLeave(event: PointerEvent): void {
    this.isPointerOver = false;
    if (this.pointers.size === 0) this.emit(this.createToolEvent("leave", event));
  }

  /** Returns the distance between the first two fingers, pixels; 0 with fewer. */
  private measureFingerDistance(): number {
    const [first, second] = [...this.pointers.values()];
    return first && second ? Math.hypot(first.x - second.x, first.y - second.y) : 0;
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    // Browsers report a horizontal wheel while Shift is held.
    const amount = event.deltaY !== 0 ? event.deltaY : event.deltaX;
    const wheel = -amount * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? WHEEL_LINE_PX : 1);
    this.emit({ ...this.createToolEvent("wheel", event), wheel });
  }

  private createToolEvent(type: ToolEvent["type"], event: MouseEvent): ToolEvent {
    const { offsetX: x, offsetY: y, buttons } = event;
    const isButtonEvent = type === "down" || type === "up";
    return {
      type,
      x,
      y,
      dx: type === "move" ? x - this.lastPosition.x : 0,
      dy: type === "move" ? y - this.lastPosition.y : 0,
      wheel: 0,
      button: isButtonEvent ? (BUTTON_NAMES[event.button] ?? null) : null,
      isLeftDown: (buttons & 1) !== 0,
      isMiddleDown: (buttons & 4) !== 0,
      isRightDown: (buttons & 2) !== 0,
      isShiftDown: event.shiftKey,
      isCtrlDown: event.ctrlKey || event.metaKey,
      isAltDown: event.altKey,
      isClick: false,
    };
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { size } = this.stage.viewport;
    const dragView = (dx: number, dy: number): void => {
      const center = { x: size.width / 2, y: size.height / 2 };
      const buttons = { isLeftDown: !event.shiftKey, isMiddleDown: event.shiftKey, isRightDown: false, isShiftDown: false };
      this.view.drag({ ...size, ...center, ...buttons, dx, dy });
    };
    switch (event.key) {
      case "ArrowLeft":
        dragView(-KEY_STEP_PX, 0);
        break;
      case "ArrowRight":
        dragView(KEY_STEP_PX, 0);
        break;
      case "ArrowUp":
        dragView(0, -KEY_STEP_PX);
        break;
      case "ArrowDown":
        dragView(0, KEY_STEP_PX);
        break;
      case "+":
      case "=":
        this.view.handleWheel(WHEEL_NOTCH, false);
        break;
      case "-":
        this.view.handleWheel(-WHEEL_NOTCH, false);
        break;
      default:
        return;
    }
    event.preventDefault();
  }
}
