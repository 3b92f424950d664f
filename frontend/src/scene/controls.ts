import { dollyDrag, dollyWheel, pan, rotate, zoomDrag, zoomWheel, type Orbit } from "../state/orbit";
import type { ViewState } from "../state/view";
import type { Stage } from "./stage";

/** A press that moves less than this is a click, pixels. */
const CLICK_SLOP = 4;
const LINE_PX = 40;
const KEY_PX = 20;
const ZOOM_NOTCH = 120;

/** The mouse bindings of RViz's Orbit view, a touch screen's, and keys. */
export class Controls {
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private travelled = 0;

  constructor(
    private readonly stage: Stage,
    private readonly view: ViewState,
  ) {
    const { canvas } = stage.viewport;
    canvas.tabIndex = 0;
    canvas.addEventListener("pointerdown", (event) => this.pressed(event));
    canvas.addEventListener("pointermove", (event) => this.moved(event));
    canvas.addEventListener("pointerup", (event) => this.released(event, true));
    canvas.addEventListener("pointercancel", (event) => this.released(event, false));
    canvas.addEventListener("wheel", (event) => this.wheeled(event), { passive: false });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("keydown", (event) => this.keyed(event));
  }

  private get height(): number {
    return this.stage.viewport.canvas.clientHeight;
  }

  private pressed(event: PointerEvent): void {
    const { canvas } = this.stage.viewport;
    if (event.button === 1) event.preventDefault();
    canvas.focus({ preventScroll: true });
    canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.travelled = this.pointers.size > 1 ? CLICK_SLOP : 0;
  }

  private moved(event: PointerEvent): void {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    if (dx === 0 && dy === 0) return;
    const spread = this.spread();
    last.x = event.clientX;
    last.y = event.clientY;
    this.travelled += Math.hypot(dx, dy);
    this.stage.focalShapeVisible = true;
    if (this.pointers.size > 1) {
      // Two fingers: each moves the view half, and their distance zooms.
      const moved = pan(this.view.orbit, dx / 2, dy / 2, this.height);
      const distance = spread > 0 ? (moved.distance * spread) / Math.max(1, this.spread()) : moved.distance;
      this.view.setOrbit({ ...moved, distance });
      return;
    }
    this.view.setOrbit(dragged(this.view.orbit, event, dx, dy, this.height));
  }

  private released(event: PointerEvent, complete: boolean): void {
    if (!this.pointers.delete(event.pointerId)) return;
    if (this.pointers.size === 0) this.stage.focalShapeVisible = false;
    const click = complete && event.button === 0 && this.travelled < CLICK_SLOP && !event.shiftKey;
    if (click) this.stage.pick(event.offsetX, event.offsetY);
  }

  /** Distance between the first two fingers, pixels; 0 with fewer. */
  private spread(): number {
    const [a, b] = [...this.pointers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  private wheeled(event: WheelEvent): void {
    event.preventDefault();
    // Browsers turn the wheel sideways while Shift is held.
    const amount = event.deltaY !== 0 ? event.deltaY : event.deltaX;
    const delta = -amount * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE_PX : 1);
    const { orbit } = this.view;
    this.view.setOrbit(event.shiftKey ? dollyWheel(orbit, delta) : zoomWheel(orbit, delta));
  }

  private keyed(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { orbit } = this.view;
    const turn = (dx: number, dy: number): Orbit =>
      event.shiftKey ? pan(orbit, dx, dy, this.height) : rotate(orbit, dx, dy);
    switch (event.key) {
      case "ArrowLeft":
        this.view.setOrbit(turn(-KEY_PX, 0));
        break;
      case "ArrowRight":
        this.view.setOrbit(turn(KEY_PX, 0));
        break;
      case "ArrowUp":
        this.view.setOrbit(turn(0, -KEY_PX));
        break;
      case "ArrowDown":
        this.view.setOrbit(turn(0, KEY_PX));
        break;
      case "+":
      case "=":
        this.view.setOrbit(zoomWheel(orbit, ZOOM_NOTCH));
        break;
      case "-":
        this.view.setOrbit(zoomWheel(orbit, -ZOOM_NOTCH));
        break;
      case "f":
      case "F":
        this.stage.focusSelected();
        break;
      case "z":
      case "Z":
        this.view.reset();
        break;
      default:
        return;
    }
    event.preventDefault();
  }
}

function dragged(orbit: Orbit, event: PointerEvent, dx: number, dy: number, height: number): Orbit {
  const [left, right, middle] = [1, 2, 4].map((bit) => (event.buttons & bit) !== 0);
  if (middle || (left && event.shiftKey)) return pan(orbit, dx, dy, height);
  if (left) return rotate(orbit, dx, dy);
  if (right) return event.shiftKey ? dollyDrag(orbit, dy) : zoomDrag(orbit, dy);
  return orbit;
}
