import { legibleView } from "./legible-view";

const SMALLEST = 0.05;
const LARGEST = 4;
const WHEEL_NOTCH = 480;
const STEP_PX = 60;
const STEP = 1.25;
/** Pixels; a press that moves less than this is a click. */
const CLICK_SLOP = 4;

/**
 * Moves and scales an image with mouse, touch pad, fingers and keys; zooming keeps the point under the pointer in
 * place.
 */
export class PanZoom {
  private x = 0;
  private y = 0;
  private zoom = 1;
  private travelled = 0;
  private readonly pointers = new Map<number, { x: number; y: number }>();

  /** @param changed - called with the transform for the image, px. */
  constructor(
    private readonly element: HTMLElement,
    private readonly changed: (x: number, y: number, scale: number) => void,
    private readonly fit: () => void,
  ) {
    element.addEventListener("wheel", (event) => this.onWheel(event), { passive: false });
    element.addEventListener("pointerdown", (event) => this.onPointerDown(event));
    element.addEventListener("pointermove", (event) => this.onPointerMove(event));
    for (const end of ["pointerup", "pointercancel"] as const) {
      element.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    element.addEventListener("dblclick", () => fit());
    element.addEventListener("keydown", (event) => this.onKeyDown(event));
  }

  get scale(): number {
    return this.zoom;
  }

  /** Whether the pointer has moved too far since the press to be a click. */
  get wasDragged(): boolean {
    return this.travelled >= CLICK_SLOP;
  }

  set(x: number, y: number, scale: number): void {
    [this.x, this.y, this.zoom] = [x, y, Math.min(Math.max(scale, SMALLEST), LARGEST)];
    this.changed(this.x, this.y, this.zoom);
  }

  /** Fits an image of this size, with a margin, at its original size at most. */
  fitImage(width: number, height: number, margin = 16): void {
    const { clientWidth, clientHeight } = this.element;
    const fits = Math.min((clientWidth - 2 * margin) / width, (clientHeight - 2 * margin) / height);
    const scale = Math.min(1, Math.max(SMALLEST, fits));
    this.set((clientWidth - width * scale) / 2, Math.max(margin, (clientHeight - height * scale) / 2), scale);
  }

  /** Shows an image of this size with legible texts; if it is too large for that, `point` is centered. */
  showLegibly(width: number, height: number, text: number, point: readonly [number, number]): void {
    const { clientWidth, clientHeight } = this.element;
    const { x, y, scale } = legibleView([width, height], [clientWidth, clientHeight], text, point);
    this.set(x, y, scale);
  }

  /** Scrolls a point of the image into view: to the center, if it is outside. */
  reveal(x: number, y: number, margin = 40): void {
    const { clientWidth, clientHeight } = this.element;
    const [at, below] = [this.x + x * this.zoom, this.y + y * this.zoom];
    const inside = at > margin && at < clientWidth - margin && below > margin && below < clientHeight - margin;
    if (!inside) this.set(clientWidth / 2 - x * this.zoom, clientHeight / 2 - y * this.zoom, this.zoom);
  }

  zoomBy(factor: number, x = this.element.clientWidth / 2, y = this.element.clientHeight / 2): void {
    const zoom = Math.min(Math.max(this.zoom * factor, SMALLEST), LARGEST);
    const real = zoom / this.zoom;
    this.set(x - (x - this.x) * real, y - (y - this.y) * real, zoom);
  }

  private onWheel(event: WheelEvent): void {
    event.preventDefault();
    const box = this.element.getBoundingClientRect();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 40 : 1;
    this.zoomBy(2 ** ((-event.deltaY * lines) / WHEEL_NOTCH), event.clientX - box.left, event.clientY - box.top);
  }

  private onPointerDown(event: PointerEvent): void {
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.travelled = this.pointers.size > 1 ? CLICK_SLOP : 0;
  }

  private onPointerMove(event: PointerEvent): void {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const spread = this.fingerDistance();
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    last.x = event.clientX;
    last.y = event.clientY;
    this.travelled += Math.hypot(dx, dy);
    if (this.wasDragged) this.element.setPointerCapture(event.pointerId);
    const count = this.pointers.size;
    this.set(this.x + dx / count, this.y + dy / count, this.zoom);
    if (count > 1 && spread > 0) {
      const box = this.element.getBoundingClientRect();
      this.zoomBy(this.fingerDistance() / spread, event.clientX - box.left, event.clientY - box.top);
    }
  }

  /** Returns the distance between the first two fingers, px. */
  private fingerDistance(): number {
    const [a, b] = [...this.pointers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  private onKeyDown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const move = (dx: number, dy: number): void => this.set(this.x + dx, this.y + dy, this.zoom);
    const keys: Readonly<Record<string, () => void>> = {
      ArrowLeft: () => move(STEP_PX, 0),
      ArrowRight: () => move(-STEP_PX, 0),
      ArrowUp: () => move(0, STEP_PX),
      ArrowDown: () => move(0, -STEP_PX),
      "+": () => this.zoomBy(STEP),
      "=": () => this.zoomBy(STEP),
      "-": () => this.zoomBy(1 / STEP),
      "0": this.fit,
    };
    const act = keys[event.key];
    if (!act) return;
    act();
    event.preventDefault();
    event.stopPropagation();
  }
}
