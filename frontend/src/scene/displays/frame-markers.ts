import type { Object3D } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { arrowHeadGeometry, arrowShaftGeometry, axesGeometry } from "../objects/geometries";

const AXIS_LENGTH = 0.2;
const AXIS_RADIUS = 0.02;

/** Axes, arrow shafts and arrow heads of all frames, as round as there is time for. */
export class FrameMarkers {
  axes: CopyBatch;
  shafts: CopyBatch;
  heads: CopyBatch;

  constructor(
    private readonly parent: Object3D,
    private segments: number,
  ) {
    [this.axes, this.shafts, this.heads] = this.make();
  }

  refine(segments: number): void {
    if (segments === this.segments) return;
    this.dispose();
    this.segments = segments;
    [this.axes, this.shafts, this.heads] = this.make();
  }

  dispose(): void {
    for (const batch of [this.axes, this.shafts, this.heads]) batch.dispose();
  }

  private make(): [CopyBatch, CopyBatch, CopyBatch] {
    return [
      new CopyBatch(this.parent, axesGeometry(AXIS_LENGTH, AXIS_RADIUS, this.segments)),
      new CopyBatch(this.parent, arrowShaftGeometry(this.segments)),
      new CopyBatch(this.parent, arrowHeadGeometry(this.segments)),
    ];
  }
}
