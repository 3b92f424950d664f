import type { Camera } from "three";
import type { ViewSize } from "../state/views/camera";
import type { Span } from "../state/views/vector";
import { reachOf, type ScreenReach } from "./screen-reach";

/** The share of the canvas's width, and of its height, that may be left out when the camera looks at all of something. */
const MOST_COVERED = 0.6;

/** What of a viewport is needed. */
interface Seen {
  readonly size: ViewSize;
  readonly camera: Camera;
  aside: number;
  below: number;
}

/** The part of the canvas that nothing covers, and robots that go there. */
export class FreeRoom {
  /** How many pixels at the right of the canvas something covers. */
  covered: () => number = () => 0;
  private above = 0;

  /**
   * @param robots the box around all robots.
   * @param aim puts the camera where it belongs.
   */
  constructor(
    private readonly viewport: Seen,
    private readonly robots: () => Span | null,
    private readonly aim: () => void,
    private readonly invalidate: () => void,
  ) {}

  /** Its size; from now on its middle is where the camera looks. */
  take(): ViewSize {
    const { width, height } = this.viewport.size;
    const [right, above] = [Math.min(this.covered(), width * MOST_COVERED), Math.min(this.above, height * MOST_COVERED)];
    Object.assign(this.viewport, { aside: right / 2, below: above / 2 });
    return { width: width - right, height: height - above };
  }

  /**
   * Moves the focal point to the middle of the part that nothing covers at the right, as far as robots stay on the
   * canvas.
   */
  makeRoom(): void {
    const { viewport } = this;
    const before = viewport.aside;
    viewport.aside = 0;
    const wanted = Math.min(this.covered(), viewport.size.width * MOST_COVERED) / 2;
    const reach = wanted > 0 ? this.reach() : null;
    viewport.aside = reach ? Math.max(0, Math.min(wanted, reach.left)) : wanted;
    if (viewport.aside !== before) this.invalidate();
  }

  /** Robots whose heads something covers, so many pixels high, go down as far as their feet stay on the canvas. */
  makeRoomAbove(height: number): void {
    const { viewport } = this;
    const before = viewport.below;
    this.above = height;
    viewport.below = 0;
    const reach = height > 0 ? this.reach() : null;
    if (reach) viewport.below = Math.max(0, Math.min(height - reach.top, viewport.size.height - reach.bottom));
    if (viewport.below !== before) this.invalidate();
  }

  /** The distance from the left edge of the canvas that robots reach, pixels: 0 without one. */
  get robotsReach(): number {
    return this.reach()?.right ?? 0;
  }

  private reach(): ScreenReach | null {
    const box = this.robots();
    this.aim();
    return box && reachOf(box, this.viewport.camera, this.viewport.size);
  }
}
