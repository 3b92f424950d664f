import type { Object3D } from "three";
import { ArrowBatch } from "../objects/arrow-batch";
import { AxesBatch } from "../objects/axes-batch";

const AXIS_LENGTH_M = 0.2;
const AXIS_RADIUS_M = 0.02;

/** The axes and arrows of all frames, with as many segments as the frame time permits. */
export class FrameMarkers {
  readonly axes: AxesBatch;
  arrows: ArrowBatch;

  constructor(
    private readonly parent: Object3D,
    private segmentCount: number,
  ) {
    this.axes = new AxesBatch(parent, AXIS_LENGTH_M, AXIS_RADIUS_M, segmentCount);
    this.arrows = new ArrowBatch(parent, segmentCount);
  }

  setSegmentCount(segmentCount: number): void {
    if (segmentCount === this.segmentCount) return;
    this.segmentCount = segmentCount;
    this.axes.setShape(AXIS_LENGTH_M, AXIS_RADIUS_M, segmentCount);
    this.arrows.dispose();
    this.arrows = new ArrowBatch(this.parent, segmentCount);
  }

  dispose(): void {
    this.axes.dispose();
    this.arrows.dispose();
  }
}
