"""The projection of cameras: pinhole cameras, and lenses with distortion.

Source: the model ``plumb_bob`` of camera calibration (Brown, "Decentering distortion of lenses", 1966); image axes of
REP 103: x to the right, y down, z into the image.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import tan

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.cameras import Camera, Distortion

_MAX_ITERATIONS = 20
"""The number of fixed-point iterations to undistort a point."""
_MAX_REACH = 2.0
"""The maximum distance from the principal point to an edge of the pinhole image, in sizes of the final image."""


@dataclass(frozen=True)
class Optics:
    """The projection of a camera.

    Attributes:
        width, height: the size of the image in pixels.
        fx, fy: the focal lengths in pixels.
        cx, cy: the principal point in pixels; the center of the first pixel is at 0.5.
        near, far: the limits of the visible distance along the optical axis, in m.
        distortion: the distortion of the lens; None for a lens without distortion.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    near: float
    far: float
    distortion: Distortion | None = None

    @cached_property
    def rays(self) -> Array:
        """The direction (x, y, 1) of each pixel in image axes, shape (height * width, 3)."""
        column_slopes = (np.arange(self.width) + 0.5 - self.cx) / self.fx
        row_slopes = (np.arange(self.height) + 0.5 - self.cy) / self.fy
        x: Array
        y: Array
        x, y = (grid.ravel() for grid in np.meshgrid(column_slopes, row_slopes))
        if self.distortion is not None:
            x, y = undistort(self.distortion, x, y)
        rays: Array = np.stack([x, y, np.ones_like(x)], axis=-1)
        return rays

    def directions(self, axes: Array) -> Array:
        """Return the direction of each pixel in another frame, shape (height * width, 3), float32.

        Args:
            axes: the image's axes (right, down, forwards) in that frame, as columns.
        """
        x_slopes, y_slopes = self.slopes
        directions = np.empty((len(x_slopes), 3), np.float32)
        for index, (right_component, down_component, forward_component) in enumerate(axes.astype(np.float32)):
            directions[:, index] = x_slopes * right_component + y_slopes * down_component + forward_component
        return directions  # type: ignore[return-value]  # 32 bits are enough here

    @cached_property
    def columns(self) -> tuple[float, float]:
        """The minimum and maximum x at z = 1 over all pixels."""
        x_slopes, _ = self.slopes
        return float(x_slopes.min()), float(x_slopes.max())

    @cached_property
    def rows(self) -> tuple[float, float]:
        """The minimum and maximum y at z = 1 over all pixels."""
        _, y_slopes = self.slopes
        return float(y_slopes.min()), float(y_slopes.max())

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """The x and y at z = 1 of each pixel, both of shape (height * width,), float32."""
        x_slopes, y_slopes, _ = np.ascontiguousarray(self.rays.T, dtype=np.float32)
        return x_slopes, y_slopes

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """The six planes of the view frustum, for square pixels without distortion.

        Returns:
            The outward unit normals of the planes in the axes right, down and forwards, shape (6, 3), and the offsets
            of the planes along their normals, in m, shape (6, 1).
        """
        left, right = -self.cx / self.fy, (self.width - self.cx) / self.fy
        top, bottom = -self.cy / self.fy, (self.height - self.cy) / self.fy
        normals = np.array(
            [
                (0.0, 0.0, -1.0),
                (0.0, 0.0, 1.0),
                (-1.0, 0.0, left),
                (1.0, 0.0, -right),
                (0.0, -1.0, top),
                (0.0, 1.0, -bottom),
            ]
        )
        outward: Array = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        return outward, np.array([[-self.near], [self.far], [0.0], [0.0], [0.0], [0.0]])

    @property
    def is_pinhole(self) -> bool:
        """Whether this is a pinhole camera with square pixels."""
        return self.distortion is None and self.fx == self.fy

    @cached_property
    def pinhole(self) -> Optics:
        """A pinhole camera with square pixels and an image that covers the image of this camera."""
        if self.is_pinhole:
            return self
        x, y = self.rays[:, 0], self.rays[:, 1]
        focal = max(self.fx, self.fy)
        left, right, top, bottom = (
            min(focal * reach + 1.0, _MAX_REACH * size)
            for reach, size in (
                (-x.min(), self.width),
                (x.max(), self.width),
                (-y.min(), self.height),
                (y.max(), self.height),
            )
        )
        left, top = float(np.ceil(max(left, 1.0))), float(np.ceil(max(top, 1.0)))
        width, height = int(left + np.ceil(max(right, 1.0))), int(top + np.ceil(max(bottom, 1.0)))
        return Optics(width, height, focal, focal, left, top, self.near, self.far)

    @cached_property
    def sources(self) -> tuple[Array, Array]:
        """For each pixel, the fractional column and row in the image of `pinhole`."""
        pinhole = self.pinhole
        return self.rays[:, 0] * pinhole.fx + pinhole.cx - 0.5, self.rays[:, 1] * pinhole.fy + pinhole.cy - 0.5

    def project(self, points: Array) -> Array:
        """Project points, shape (n, 3) with z > 0, to columns and rows in pixels, shape (n, 2)."""
        x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
        if self.distortion is not None:
            x, y = distort(self.distortion, x, y)
        pixels: Array = np.stack([x * self.fx + self.cx, y * self.fy + self.cy], axis=-1)
        return pixels


def make_optics(camera: Camera) -> Optics:
    """Return the optics of an SDF camera."""
    width, height = max(camera.image.width, 1), max(camera.image.height, 1)
    clip = camera.clip
    nearest = max(clip.near, 1e-3)
    farthest = max(clip.far, nearest * 2)
    distortion, intrinsics = camera.distortion, camera.intrinsics
    is_distorted = distortion is not None and any(
        (distortion.k1, distortion.k2, distortion.k3, distortion.p1, distortion.p2)
    )
    focal = width / (2 * tan(min(max(camera.horizontal_fov, 1e-3), 3.1) / 2))
    if intrinsics is not None and intrinsics.fx > 0 and intrinsics.fy > 0:
        focal_and_center = intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy
    else:
        focal_and_center = focal, focal, width / 2, height / 2
    return Optics(width, height, *focal_and_center, nearest, farthest, distortion if is_distorted else None)


def distort(lens: Distortion, x: Array, y: Array) -> tuple[Array, Array]:
    """Return x and y at z = 1 after the distortion of a lens."""
    squared_radius = x * x + y * y
    radial = 1 + squared_radius * (lens.k1 + squared_radius * (lens.k2 + squared_radius * lens.k3))
    distorted_x = x * radial + 2 * lens.p1 * x * y + lens.p2 * (squared_radius + 2 * x * x)
    distorted_y = y * radial + lens.p1 * (squared_radius + 2 * y * y) + 2 * lens.p2 * x * y
    return distorted_x, distorted_y


def undistort(lens: Distortion, x: Array, y: Array) -> tuple[Array, Array]:
    """Return x and y at z = 1 before the distortion of a lens.

    A fixed-point iteration computes them. Points for which it diverges are returned unchanged.
    """
    estimated_x, estimated_y = x.copy(), y.copy()
    for _ in range(_MAX_ITERATIONS):
        distorted = distort(lens, estimated_x, estimated_y)
        estimated_x, estimated_y = estimated_x + (x - distorted[0]), estimated_y + (y - distorted[1])
    has_converged = (np.abs(estimated_x) < 10) & (np.abs(estimated_y) < 10)  # The comparison is false for NaN.
    return np.where(has_converged, estimated_x, x), np.where(has_converged, estimated_y, y)
