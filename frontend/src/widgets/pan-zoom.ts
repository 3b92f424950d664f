import { computeLegibleView } from "./legible-view";

const MIN_SCALE = 0.05;
const MAX_SCALE = 4;
const WHEEL_PX_PER_DOUBLING = 480;
const MOVE_STEP_PX = 60;
const ZOOM_STEP = 1.25;
/** Pixels; a press that moves less than this is a click. */
const MAX_CLICK_MOVE_PX = 4;

/**
 * Moves and scales an image with mouse, touch pad, fingers and keys; zooming keeps the point under the pointer in
 * place.
 */
export class PanZoom {
  private x = 0;
  private y = 0;
  private zoom = 1;
  private traveledPx = 0;
  private readonly pointers = new Map<number, { x: number; y: number }>();

  /** @param onChanged - called with the transform for the image, px. */
  constructor(
    private readonly element: HTMLElement,
    private readonly onChanged: (x: number, y: number, scale: number) => void,
    private readonly fit: () => void,
  ) {
    element.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
    element.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    element.addEventListener("pointermove", (event) => this.onPointerMove(event));
    for (const eventType of ["pointerup", "pointercancel"] as const) {
      element.addEventListener(eventType, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener("dblclick", () => fit());
    element.addEventListener("keydown", (event) => this.onKeyDown(event));
  }

  get scale(): number {
    return this.zoom;
  }

  /** Whether the pointer has moved too far since the press to be a click. */
  get wasDragged(): boolean {
    return this.traveledPx >= MAX_CLICK_MOVE_PX;
  }

  setView(x: number, y: number, scale: number): void {
    [this.x, this.y, this.zoom] = [x, y, Math.min(Math.max(scale, MIN_SCALE), MAX_SCALE)];
    this.onChanged(this.x, this.y, this.zoom);
  }

  /** Fits an image of this size, with a margin, at its original size at most. */
  fitImage(width: number, height: number, margin = 16): void {
    const { clientWidth, clientHeight } = this.element;
    const fittingScale = Math.min((clientWidth - 2 * margin) / width, (clientHeight - 2 * margin) / height);
    const scale = Math.min(1, Math.max(MIN_SCALE, fittingScale));
    this.setView((clientWidth - width * scale) / 2, Math.max(margin, (clientHeight - height * scale) / 2), scale);
  }

  /** Shows an image of this size with legible texts; if it is too large for that, `point` is centered. */
  showLegibly(width: number, height: number, textSize: number, point: readonly [number, number]): void {
    const { clientWidth, clientHeight } = this.element;
    const { x, y, scale } = computeLegibleView([width, height], [clientWidth, clientHeight], textSize, point);
    this.setView(x, y, scale);
  }

  /** Scrolls a point of the image into view: to the center, if it is outside. */
  reveal(x: number, y: number, margin = 40): void {
    const { clientWidth, clientHeight } = this.element;
    const [left, top] = [this.x + x * this.zoom, this.y + y * this.zoom];
    const isInside = left > margin && left < clientWidth - margin && top > margin && top < clientHeight - margin;
    if (!isInside) this.setView(clientWidth / 2 - x * this.zoom, clientHeight / 2 - y * this.zoom, this.zoom);
  }

  zoomBy(factor: number, x = this.element.clientWidth / 2, y = this.element.clientHeight / 2): void {
    const zoom = Math.min(Math.max(this.zoom * factor, MIN_SCALE), MAX_SCALE);
    const actualFactor = zoom / this.zoom;
    this.setView(x - (x - this.x) * actualFactor, y - (y - this.y) * actualFactor, zoom);
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const elementRect = this.element.getBoundingClientRect();
    const pxPerUnit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 40 : 1;
    this.zoomBy(2 ** ((-event.deltaY * pxPerUnit) / WHEEL_PX_PER_DOUBLING), event.clientX - elementRect.left, event.clientY - elementRect.top);
  }

  private onPointerDown(event: PointerEvent): void {
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.traveledPx = this.pointers.size > 1 ? MAX_CLICK_MOVE_PX : 0;
  }

  private onPointerMove(event: PointerEvent): void {
    const lastPoint = this.pointers.get(event.pointerId);
    if (!lastPoint) return;
    const lastDistance = this.measureFingerDistance();
    const [dx, dy] = [event.clientX - lastPoint.x, event.clientY - lastPoint.y];
    lastPoint.x = event.clientX;
    lastPoint.y = event.clientY;
    this.traveledPx += Math.hypot(dx, dy);
    if (this.wasDragged) this.element.setPointerCapture(event.pointerId);
    const count = this.pointers.size;
    this.setView(this.x + dx / count, this.y + dy / count, this.zoom);
    if (count > 1 && lastDistance > 0) {
      const elementRect = this.element.getBoundingClientRect();
      this.zoomBy(this.measureFingerDistance() / lastDistance, event.clientX - elementRect.left, event.clientY - elementRect.top);
    }
  }

  /** Returns the distance between the first two fingers, px. */
  private measureFingerDistance(): number {
    const [first, second] = [...this.pointers.values()];
    return first && second ? Math.hypot(first.x - second.x, first.y - second.y) : 0;
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const move = (dx: number, dy: number): void => this.setView(this.x + dx, this.y + dy, this.zoom);
    const commands: Readonly<Record<string, () => void>> = {
      ArrowLeft: () => move(MOVE_STEP_PX, 0),
      ArrowRight: () => move(-MOVE_STEP_PX, 0),
      ArrowUp: () => move(0, MOVE_STEP_PX),
      ArrowDown: () => move(0, -MOVE_STEP_PX),
      "+": () => this.zoomBy(ZOOM_STEP),
      "=": () => this.zoomBy(ZOOM_STEP),
      "-": () => this.zoomBy(1 / ZOOM_STEP),
      "0": this.fit,
    };
    const runCommand = commands[event.key];
    if (!runCommand) return;
    runCommand();
    event.preventDefault();
    event.stopPropagation();
  }
}
