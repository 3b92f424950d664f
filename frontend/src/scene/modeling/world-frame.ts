import { Matrix4, Plane, Vector3 } from "three";
import type { GroundPosition } from "../../state/modeling/shapes";
import type { Stage } from "../stage";

const GROUND = new Plane(new Vector3(0, 0, 1), 0);

/** Returns the pose of the world in the fixed frame. */
export function computeWorldFrame(stage: Stage): Matrix4 {
  return stage.world?.drawing.computeWorldPose() ?? new Matrix4();
}

/** Returns the point of the world's ground, z = 0, at a canvas position in pixels. */
export function groundPositionAt(stage: Stage, x: number, y: number): GroundPosition | null {
  const ray = stage.picker.rayAt(x, y).ray.clone().applyMatrix4(computeWorldFrame(stage).invert());
  const point = ray.intersectPlane(GROUND, new Vector3());
  return point && [point.x, point.y];
}
