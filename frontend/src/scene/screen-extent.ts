import { Vector3, type Camera } from "three";
import type { ViewSize } from "../state/views/camera";
import type { Bounds } from "../state/views/vector";

/** The extent of a box on a canvas, in pixels from its left and its upper edge. */
export interface ScreenExtent {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

/** Returns the extent of a box on a canvas; infinite if a part of the box is behind the camera. */
export function computeExtent({ min, max }: Bounds, camera: Camera, { width, height }: ViewSize): ScreenExtent {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((corner) => {
    return new Vector3(...([0, 1, 2] as const).map((axis) => ((corner >> axis) & 1 ? max : min)[axis])).applyMatrix4(camera.matrixWorldInverse);
  });
  if (corners.some(({ z }) => z >= 0)) return { left: -Infinity, right: Infinity, top: -Infinity, bottom: Infinity };
  const projectedCorners = corners.map((corner) => corner.applyMatrix4(camera.projectionMatrix));
  const xs = projectedCorners.map(({ x }) => ((x + 1) / 2) * width);
  const ys = projectedCorners.map(({ y }) => ((1 - y) / 2) * height);
  return { left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys) };
}
