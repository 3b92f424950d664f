import type { Matrix4 } from "three";

/** The numbers of a pose: x y z qx qy qz qw. */
const POSE_SIZE = 7;

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

  /** Premultiplies the pose of a link by the displacement of its model, and returns the pose. */
  apply(link: string, pose: Matrix4): Matrix4 {
    const offset = this.models.size > 0 ? this.models.get(modelOf(link)) : undefined;
    return offset ? pose.premultiply(offset) : pose;
  }

  /** Clears the displacement if the actual pose of a displaced model has changed. */
  clearIfPosesChanged(oldPoses: Float32Array, newPoses: Float32Array, rowByLink: ReadonlyMap<string, number>): void {
    if (this.models.size === 0) return;
    for (const [link, row] of rowByLink) {
      if (!this.models.has(modelOf(link))) continue;
      const start = row * POSE_SIZE;
      for (let i = start; i < start + POSE_SIZE; i++) {
        if (oldPoses[i] === newPoses[i]) continue;
        this.models = new Map();
        return;
      }
    }
  }
}
