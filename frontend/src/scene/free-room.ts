import type { Camera } from "three";
import type { ViewSize } from "../state/views/camera";
import type { Span } from "../state/views/vector";
import { extentOf, type ScreenExtent } from "./screen-extent";

/** The maximum share of the canvas's width and height that may be excluded when the camera fits something into view. */
const MAX_COVERED = 0.6;

/** The part of a viewport that is used here. */
interface ShiftedView {
  readonly size: ViewSize;
  readonly camera: Camera;
  shiftLeft: number;
  shiftDown: number;
}

/** The part of the canvas that nothing covers, and the moves of the view that bring robots into it. */
export class FreeRoom {
  /** Returns the width covered at the right of the canvas, pixels. */
  getCoveredWidth: () => number = () => 0;
  private coveredAbove = 0;

  /**
   * @param computeRobotSpan - returns the bounding box of all robots.
   * @param aim - updates the camera.
   */
  constructor(
    private readonly viewport: ShiftedView,
    private readonly computeRobotSpan: () => Span | null,
    private readonly aim: () => void,
    private readonly invalidate: () => void,
  ) {}

  /** Returns the size of the free part, and moves the camera's center to the center of that part. */
  center(): ViewSize {
    const { width, height } = this.viewport.size;
    const [right, coveredHeight] = [Math.min(this.getCoveredWidth(), width * MAX_COVERED), Math.min(this.coveredAbove, height * MAX_COVERED)];
    Object.assign(this.viewport, { shiftLeft: right / 2, shiftDown: coveredHeight / 2 });
    return { width: width - right, height: height - coveredHeight };
  }

  /**
   * Moves the focal point to the center of the part that nothing covers at the right, as far as robots stay on the
   * canvas.
   */
  makeRoom(): void {
    const { viewport } = this;
    const previousShift = viewport.shiftLeft;
    viewport.shiftLeft = 0;
    const target = Math.min(this.getCoveredWidth(), viewport.size.width * MAX_COVERED) / 2;
    const extent = target > 0 ? this.extentOfRobots() : null;
    viewport.shiftLeft = extent ? Math.max(0, Math.min(target, extent.left)) : target;
    if (viewport.shiftLeft !== previousShift) this.invalidate();
  }

  /**
   * Moves robots down whose tops are covered by something of this height, pixels, as far as their feet stay on the
   * canvas.
   */
  makeRoomAbove(height: number): void {
    const { viewport } = this;
    const previousShift = viewport.shiftDown;
    this.coveredAbove = height;
    viewport.shiftDown = 0;
    const extent = height > 0 ? this.extentOfRobots() : null;
    if (extent) viewport.shiftDown = Math.max(0, Math.min(height - extent.top, viewport.size.height - extent.bottom));
    if (viewport.shiftDown !== previousShift) this.invalidate();
  }

  /** The rightmost pixel column that robots cover, from the left edge of the canvas; 0 without robots. */
  get robotsReach(): number {
    return this.extentOfRobots()?.right ?? 0;
  }

  private extentOfRobots(): ScreenExtent | null {
    const box = this.computeRobotSpan();
    this.aim();
    return box && extentOf(box, this.viewport.camera, this.viewport.size);
  }
}
