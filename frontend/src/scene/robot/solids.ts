import type { Matrix4, Object3D } from "three";
import { CopyBatch } from "../objects/copy-batch";
import { paint, unitBox, unitCone, unitCylinder, unitSphere } from "../objects/geometries";

const GEOMETRIES = { box: unitBox, cylinder: unitCylinder, cone: unitCone, sphere: unitSphere } as const;

/** A kind of shape of which all are drawn in one call. */
export type SolidKind = keyof typeof GEOMETRIES;

/** What shapes of a kind are drawn together with; null for those that are not. */
export function solidKind(kind: string): SolidKind | null {
  if (kind === "ellipsoid") return "sphere";
  return kind in GEOMETRIES ? (kind as SolidKind) : null;
}

/** Draws boxes, cylinders, cones and spheres that hide what is behind them; used as `CopyBatch`: `begin`, `add` each, `end`. */
export class Solids {
  private readonly batches: ReadonlyMap<SolidKind, CopyBatch>;

  constructor(parent: Object3D) {
    const kinds = Object.keys(GEOMETRIES) as SolidKind[];
    this.batches = new Map(kinds.map((kind) => [kind, new CopyBatch(parent, paint(GEOMETRIES[kind].clone(), 1, 1, 1))]));
  }

  /** How many are drawn. */
  get size(): number {
    return [...this.batches.values()].reduce((sum, batch) => sum + batch.size, 0);
  }

  /** Starts over; at most so many of each kind will follow. */
  begin(counts: ReadonlyMap<SolidKind, number>): void {
    for (const [kind, batch] of this.batches) batch.begin(counts.get(kind) ?? 0);
  }

  /** `matrix` in the parent's frame, of a shape of size one; `color` is 0xrrggbb. */
  add(kind: SolidKind, matrix: Matrix4, color: number): void {
    this.batches.get(kind)?.add(matrix, 0, 1, color);
  }

  end(): void {
    for (const batch of this.batches.values()) batch.end();
  }

  dispose(): void {
    for (const batch of this.batches.values()) batch.dispose();
  }
}
