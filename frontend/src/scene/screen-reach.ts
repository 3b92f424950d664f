import { Vector3, type Camera } from "three";
import type { Span } from "../state/views/fit";

/** How far from the left edge of a canvas a box reaches, pixels: to infinity where a part of it is behind the eye. */
export function reachOf({ min, max }: Span, camera: Camera, width: number): number {
  const xs = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => {
    const point = new Vector3(...([0, 1, 2] as const).map((axis) => ((corner >> axis) & 1 ? max : min)[axis]));
    if (point.applyMatrix4(camera.matrixWorldInverse).z >= 0) return Infinity;
    return ((point.applyMatrix4(camera.projectionMatrix).x + 1) / 2) * width;
  });
  return Math.max(...xs);
}
