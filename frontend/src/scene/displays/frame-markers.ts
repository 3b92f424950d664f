import type { Object3D } from "three";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";

const AXIS_LENGTH = 0.2;
const AXIS_RADIUS = 0.02;

/** The axes and arrows of all frames, with as many segments as the frame time permits. */
export class FrameMarkers {
  readonly axes: AxesBatch;
  arrows: ArrowBatch;

  constructor(
    private readonly parent: Object3D,
    private segments: number,
  ) {
    this.axes = new AxesBatch(parent, AXIS_LENGTH, AXIS_RADIUS, segments);
    this.arrows = new ArrowBatch(parent, segments);
  }

  refine(segments: number): void {
    if (segments === this.segments) return;
    this.segments = segments;
    this.axes.setShape(AXIS_LENGTH, AXIS_RADIUS, segments);
    this.arrows.dispose();
    this.arrows = new ArrowBatch(this.parent, segments);
  }

  dispose(): void {
    this.axes.dispose();
    this.arrows.dispose();
  }
}
