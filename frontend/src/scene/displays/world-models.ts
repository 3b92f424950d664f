import type { Matrix4 } from "three";

const NUMBERS = 7;

/** Returns the model of the world to which a link, `model::link`, belongs. */
export function modelOf(link: string): string {
  return link.split("::", 1)[0] ?? link;
}

/** Models that are shown away from their actual poses, while the user moves them. */
export class Displacement {
  private models: ReadonlyMap<string, Matrix4> = new Map();

  /** Sets the matrices that premultiply the models' poses in the world. */
  set(models: ReadonlyMap<string, Matrix4>): void {
    this.models = models;
  }

  apply(link: string, pose: Matrix4): Matrix4 {
    const moved = this.models.size > 0 && this.models.get(modelOf(link));
    return moved ? pose.premultiply(moved) : pose;
  }

  /** Ends the displacement once the actual poses of these models have changed. */
  endIfMoved(before: Float32Array, after: Float32Array, rowOf: ReadonlyMap<string, number>): void {
    if (this.models.size === 0) return;
    for (const [link, row] of rowOf) {
      if (!this.models.has(modelOf(link))) continue;
      const at = row * NUMBERS;
      for (let i = at; i < at + NUMBERS; i++) {
        if (before[i] === after[i]) continue;
        this.models = new Map();
        return;
      }
    }
  }
}
