"""Camera models: a pinhole camera, and a lens with distortion.

Sources: sensor_msgs/msg/CameraInfo, and OpenCV's camera model with its coefficients. The axes follow REP 103: x to
the right, y down, z into the image. Pixel coordinates are as in boxes: pixel 0 extends from 0 to 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_UNDISTORT_ITERATIONS = 20
"""The number of iterations that undistort a point."""
_PIXEL_CENTER = 0.5
"""The offset in pixels: CameraInfo counts from the center of pixel 0, boxes count from its edge."""
_MAX_COEFFICIENTS = 8
_DISTORTION_MODELS = ("", "plumb_bob", "rational_polynomial")


@dataclass(frozen=True, slots=True)
class CameraModel:
    """The intrinsics of a camera.

    Attributes:
        width, height: the size of its images, pixels.
        fx, fy: focal lengths, pixels.
        cx, cy: the principal point, pixels.
        distortion: the coefficients k1, k2, p1, p2, k3, k4, k5, k6 of the lens; missing ones are 0.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()

    def rays_from_pixels(self, pixels: Floats) -> Floats:
        """Return the viewing rays through points of the image.

        Args:
            pixels: shape ``(n, 2)``, x and y in pixels.

        Returns:
            Shape ``(n, 3)``: x, y, z with z = 1, in the optical frame.
        """
        x = (pixels[:, 0] - self.cx) / self.fx
        y = (pixels[:, 1] - self.cy) / self.fy
        if any(self.distortion):
            x, y = self._undistort(x, y)
        return np.stack([x, y, np.ones_like(x)], axis=-1)

    def pixels_from_points(self, points: Floats) -> Floats:
        """Project points ``(n, 3)`` in the optical frame, z not 0, to pixels ``(n, 2)``."""
        x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
        if any(self.distortion):
            radial, shift_x, shift_y = self._compute_distortion(x, y)
            x, y = x * radial + shift_x, y * radial + shift_y
        return np.stack([x * self.fx + self.cx, y * self.fy + self.cy], axis=-1)

    def _undistort(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        undistorted_x, undistorted_y = x, y
        for _ in range(_UNDISTORT_ITERATIONS):
            radial, shift_x, shift_y = self._compute_distortion(undistorted_x, undistorted_y)
            undistorted_x, undistorted_y = (x - shift_x) / radial, (y - shift_y) / radial
        return undistorted_x, undistorted_y

    def _compute_distortion(self, x: Floats, y: Floats) -> tuple[Floats, Floats, Floats]:
        k1, k2, p1, p2, k3, k4, k5, k6 = (*self.distortion, *[0.0] * (_MAX_COEFFICIENTS - len(self.distortion)))
        radius_squared = x * x + y * y
        numerator = 1 + radius_squared * (k1 + radius_squared * (k2 + radius_squared * k3))
        denominator = 1 + radius_squared * (k4 + radius_squared * (k5 + radius_squared * k6))
        shift_x = 2 * p1 * x * y + p2 * (radius_squared + 2 * x * x)
        shift_y = p1 * (radius_squared + 2 * y * y) + 2 * p2 * x * y
        return numerator / denominator, shift_x, shift_y


def make_camera_model(
    width: int,
    height: int,
    k: Sequence[float],
    d: Sequence[float] = (),
    p: Sequence[float] = (),
    distortion_model: str = "",
) -> CameraModel:
    """Return the camera model of a CameraInfo for raw images (``image_raw``).

    Args:
        width: the width of the images, pixels.
        height: the height of the images, pixels.
        k: the matrix for the distorted image, nine numbers row by row; zeros if the camera is not calibrated.
        d: the distortion coefficients.
        p: the matrix for the rectified image, twelve numbers; used if k is empty or zero.
        distortion_model: the distortion model, ``plumb_bob`` or ``rational_polynomial``.

    Raises:
        ValueError: the focal length or the size is missing, or the distortion model is not supported.
    """
    if width <= 0 or height <= 0:
        raise ValueError(f"the camera's images are {width} x {height} pixels")
    if len(k) and k[0] > 0 and k[4] > 0:
        if any(d) and distortion_model not in _DISTORTION_MODELS:
            raise ValueError(
                f"the distortion model '{distortion_model}' is not supported; use plumb_bob or rational_polynomial"
            )
        coefficients = tuple(float(coefficient) for coefficient in d[:_MAX_COEFFICIENTS])
        return CameraModel(
            width, height, float(k[0]), float(k[4]), float(k[2]) + _PIXEL_CENTER, k[5] + _PIXEL_CENTER, coefficients
        )
    if len(p) and p[0] > 0 and p[5] > 0:
        return CameraModel(width, height, float(p[0]), float(p[5]), float(p[2]) + _PIXEL_CENTER, p[6] + _PIXEL_CENTER)
    raise ValueError("the camera has no focal length: both K and P are zero")
