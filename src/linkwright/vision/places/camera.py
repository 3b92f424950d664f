"""Camera models: a pinhole camera, and a lens with distortion.

Source: sensor_msgs/msg/CameraInfo, and OpenCV's camera model with its coefficients. The axes are those of REP 103: x to
the right, y down, z into the image. Pixel coordinates are those of boxes: pixel 0 extends from 0 to 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_TURNS = 20
"""The number of iterations that undistort a point."""
_MIDDLE = 0.5
"""The offset in pixels between CameraInfo's origin, the middle of pixel 0, and that of boxes, its edge."""
_MOST_COEFFICIENTS = 8
_LENSES = ("", "plumb_bob", "rational_polynomial")


@dataclass(frozen=True, slots=True)
class CameraModel:
    """The intrinsics of a camera.

    Attributes:
        width, height: the size of its images, pixels.
        fx, fy: focal lengths, pixels.
        cx, cy: the principal point, pixels.
        distortion: the coefficients k1, k2, p1, p2, k3, k4, k5, k6 of the lens; fewer or none for a simpler lens.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion: tuple[float, ...] = ()

    def rays(self, pixels: Floats) -> Floats:
        """Return the viewing rays of pixels.

        Args:
            pixels: shape ``(n, 2)``, columns and rows.

        Returns:
            Shape ``(n, 3)``: x, y, z with z = 1, in the optical frame.
        """
        x = (pixels[:, 0] - self.cx) / self.fx
        y = (pixels[:, 1] - self.cy) / self.fy
        if any(self.distortion):
            x, y = self._undistorted(x, y)
        return np.stack([x, y, np.ones_like(x)], axis=-1)

    def pixels(self, points: Floats) -> Floats:
        """Project points in the optical frame to pixels: shapes ``(n, 3)`` and ``(n, 2)``; z must not be 0."""
        x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
        if any(self.distortion):
            radial, across, down = self._bent(x, y)
            x, y = x * radial + across, y * radial + down
        return np.stack([x * self.fx + self.cx, y * self.fy + self.cy], axis=-1)

    def _undistorted(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        straight_x, straight_y = x, y
        for _ in range(_TURNS):
            radial, across, down = self._bent(straight_x, straight_y)
            straight_x, straight_y = (x - across) / radial, (y - down) / radial
        return straight_x, straight_y

    def _bent(self, x: Floats, y: Floats) -> tuple[Floats, Floats, Floats]:
        k1, k2, p1, p2, k3, k4, k5, k6 = (*self.distortion, *[0.0] * (_MOST_COEFFICIENTS - len(self.distortion)))
        square = x * x + y * y
        above = 1 + square * (k1 + square * (k2 + square * k3))
        below = 1 + square * (k4 + square * (k5 + square * k6))
        across = 2 * p1 * x * y + p2 * (square + 2 * x * x)
        down = p1 * (square + 2 * y * y) + 2 * p2 * x * y
        return above / below, across, down


def camera_model(
    width: int, height: int, k: Sequence[float], d: Sequence[float] = (), p: Sequence[float] = (), lens: str = ""
) -> CameraModel:
    """Return the camera model of a CameraInfo, for raw images (``image_raw``).

    Args:
        width: the width of its images.
        height: the height of its images.
        k: the matrix for the distorted image, nine numbers row by row; zeros if the camera is not calibrated.
        d: the distortion coefficients.
        p: the matrix for the rectified image, twelve numbers; used if k is empty or zero.
        lens: the distortion model, ``plumb_bob`` or ``rational_polynomial``.

    Raises:
        ValueError: the focal length or the size is missing, or the distortion model is unknown.
    """
    if width <= 0 or height <= 0:
        raise ValueError(f"the camera's images are {width} x {height} pixels")
    if len(k) and k[0] > 0 and k[4] > 0:
        if any(d) and lens not in _LENSES:
            raise ValueError(f"the distortion model '{lens}' is not known; it is one of plumb_bob, rational_polynomial")
        lens_is = tuple(float(coefficient) for coefficient in d[:_MOST_COEFFICIENTS])
        return CameraModel(width, height, float(k[0]), float(k[4]), float(k[2]) + _MIDDLE, k[5] + _MIDDLE, lens_is)
    if len(p) and p[0] > 0 and p[5] > 0:
        return CameraModel(width, height, float(p[0]), float(p[5]), float(p[2]) + _MIDDLE, p[6] + _MIDDLE)
    raise ValueError("the camera has no focal length: both K and P are zero")
