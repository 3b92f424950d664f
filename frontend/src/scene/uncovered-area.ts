import type { Camera } from "three";
import type { ViewSize } from "../state/views/camera";
import type { Bounds } from "../state/views/vector";
import { computeExtent, type ScreenExtent } from "./screen-extent";

/** The maximum share of the canvas's width and height that may be excluded when the camera fits something into view. */
const MAX_COVERED_SHARE = 0.6;

/** A viewport whose center can be shifted on the canvas; what `UncoveredArea` needs of `Viewport`. */
interface OffCenterView {
  readonly size: ViewSize;
  readonly camera: Camera;
  shiftLeft: number;
  shiftDown: number;
}

/** The part of the canvas that no card or notice covers. Its methods shift the view so that robots are in this part. */
export class UncoveredArea {
  /** Returns the width covered at the right of the canvas, pixels. */
  getCoveredWidth: () => number = () => 0;
  private noticeHeight = 0;

  /**
   * @param computeRobotBounds - returns the bounding box of all robots.
   * @param updateCamera - applies the shift to the camera.
   */
  constructor(
    private readonly viewport: OffCenterView,
    private readonly computeRobotBounds: () => Bounds | null,
    private readonly updateCamera: () => void,
    private readonly invalidate: () => void,
  ) {}

  /** Returns the size of the free part, and moves the camera's center to the center of that part. */
  centerView(): ViewSize {
    const { width, height } = this.viewport.size;
    const [coveredWidth, coveredHeight] = [Math.min(this.getCoveredWidth(), width * MAX_COVERED_SHARE), Math.min(this.noticeHeight, height * MAX_COVERED_SHARE)];
    Object.assign(this.viewport, { shiftLeft: coveredWidth / 2, shiftDown: coveredHeight / 2 });
    return { width: width - coveredWidth, height: height - coveredHeight };
  }

  /**
   * Shifts the view left, so that the focal point is in the center of the part beside the cards, but no farther than
   * keeps the robots on the canvas.
   */
  avoidCards(): void {
    const { viewport } = this;
    const previousShift = viewport.shiftLeft;
    viewport.shiftLeft = 0;
    const target = Math.min(this.getCoveredWidth(), viewport.size.width * MAX_COVERED_SHARE) / 2;
    const extent = target > 0 ? this.computeRobotExtent() : null;
    viewport.shiftLeft = extent ? Math.max(0, Math.min(target, extent.left)) : target;
    if (viewport.shiftLeft !== previousShift) this.invalidate();
  }

  /**
   * Shifts the view down so that a notice of this height (pixels) does not cover the robots, but no farther than keeps
   * their lower ends on the canvas.
   */
  avoidNotices(height: number): void {
    const { viewport } = this;
    const previousShift = viewport.shiftDown;
    this.noticeHeight = height;
    viewport.shiftDown = 0;
    const extent = height > 0 ? this.computeRobotExtent() : null;
    if (extent) viewport.shiftDown = Math.max(0, Math.min(height - extent.top, viewport.size.height - extent.bottom));
    if (viewport.shiftDown !== previousShift) this.invalidate();
  }

  /** The rightmost pixel column that robots cover, from the left edge of the canvas; 0 without robots. */
  get robotsRightEdge(): number {
    return this.computeRobotExtent()?.right ?? 0;
  }

  private computeRobotExtent(): ScreenExtent | null {
    const box = this.computeRobotBounds();
    this.updateCamera();
    return box && computeExtent(box, this.viewport.camera, this.viewport.size);
  }
}
