import { Matrix4 } from "three";
import type { CameraModel } from "../../protocol";

const NEAR_PLANE_M = 0.01;

/** Returns the share of a window that an image covers along x and y without distortion, by RViz's rule. */
export function computeZoom(
  camera: CameraModel,
  factor: number,
  windowWidth: number,
  windowHeight: number,
): readonly [number, number] {
  const imageAspect = camera.width / camera.focal_x / (camera.height / camera.focal_y);
  const windowAspect = windowWidth / windowHeight;
  return imageAspect > windowAspect ? [factor, (factor / imageAspect) * windowAspect] : [(factor / windowAspect) * imageAspect, factor];
}

/**
 * Returns the projection of a pinhole camera whose image covers `zoom` of the window; the far plane is at
 * `farDistance`, m.
 */
export function createProjection(camera: CameraModel, zoom: readonly [number, number], farDistance: number): Matrix4 {
  const { width, height, focal_x, focal_y, center_x, center_y } = camera;
  const x = ((2 * focal_x) / width) * zoom[0];
  const y = ((2 * focal_y) / height) * zoom[1];
  const shiftX = 2 * (0.5 - center_x / width) * zoom[0];
  const shiftY = 2 * (center_y / height - 0.5) * zoom[1];
  const far = Math.max(farDistance, NEAR_PLANE_M * 2);
  const depth = -(far + NEAR_PLANE_M) / (far - NEAR_PLANE_M);
  const shift = (-2 * far * NEAR_PLANE_M) / (far - NEAR_PLANE_M);
  return new Matrix4().set(x, 0, shiftX, 0, 0, y, shiftY, 0, 0, 0, depth, shift, 0, 0, -1, 0);
}

/**
 * Returns the pose of the camera in the frame of its image, rotated from the image's axes (z forward) to the scene's (z
 * backward).
 */
export function createCameraPose({ offset_x, offset_y }: CameraModel): Matrix4 {
  return new Matrix4().makeRotationX(Math.PI).setPosition(offset_x, offset_y, 0);
}
