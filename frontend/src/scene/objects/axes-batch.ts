import type { Box3, Matrix4, Object3D, Raycaster } from "three";
import { CopyBatch, type CopyHit } from "./copy-batch";
import { createAxes } from "./geometries";

/** Any number of axes of one size in one draw call: x red, y green, z blue. */
export class AxesBatch {
  private copies: CopyBatch;
  private shapeKey = "";

  constructor(
    private readonly parent: Object3D,
    length = 1,
    radius = 0.1,
    segments = 12,
  ) {
    this.copies = this.createBatch(length, radius, segments);
  }

  /** The number of axes drawn now. */
  get size(): number {
    return this.copies.size;
  }

  /** Changes the size, m; for the radius see `createAxes`. Must be called before `begin`. */
  setShape(length: number, radius: number, segments = 12): void {
    if (this.shapeKey === [length, radius, segments].join()) return;
    this.copies.dispose();
    this.copies = this.createBatch(length, radius, segments);
  }

  /** Removes all axes; at most `capacity` will be added. */
  begin(capacity: number): void {
    this.copies.begin(capacity);
  }

  add(pose: Matrix4, gray = 0, alpha = 1): void {
    this.copies.add(pose, gray, alpha);
  }

  end(): void {
    this.copies.end();
  }

  expandBox(box: Box3): void {
    this.copies.expandBox(box);
  }

  /** Returns the nearest axes that a ray hits. */
  pick(ray: Raycaster): CopyHit | null {
    return this.copies.pick(ray);
  }

  dispose(): void {
    this.copies.dispose();
  }

  private createBatch(length: number, radius: number, segments: number): CopyBatch {
    this.shapeKey = [length, radius, segments].join();
    return new CopyBatch(this.parent, createAxes(length, radius, segments));
  }
}
