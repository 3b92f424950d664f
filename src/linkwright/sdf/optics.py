"""Camera models: pinhole cameras, and lenses with distortion.

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

_TURNS = 20
"""The number of iterations that undistort a point."""
_LARGEST = 2.0
"""The greatest width of the pinhole image that is resampled for a distorted image, in widths of the latter."""


@dataclass(frozen=True)
class Optics:
    """The projection of a camera.

    Attributes:
        width, height: the size of the image in pixels.
        fx, fy: the focal lengths in pixels.
        cx, cy: the principal point, in pixels from the outer corner of the first pixel, whose centre is at 0.5.
        near, far: the limits of the visible distance along the optical axis, in m.
        distortion: the distortion of the lens; None if there is none.
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
        """The direction of each pixel, with x, y and z = 1, shape (height * width, 3)."""
        across = (np.arange(self.width) + 0.5 - self.cx) / self.fx
        down = (np.arange(self.height) + 0.5 - self.cy) / self.fy
        x: Array
        y: Array
        x, y = (item.ravel() for item in np.meshgrid(across, down))
        if self.distortion is not None:
            x, y = undistorted(self.distortion, x, y)
        rays: Array = np.stack([x, y, np.ones_like(x)], axis=-1)
        return rays

    def directions(self, axes: Array) -> Array:
        """Return the direction of each pixel in other axes, shape (height * width, 3), float32.

        Args:
            axes: right, down and forwards, as columns.
        """
        across, down = self.slopes
        directions = np.empty((len(across), 3), np.float32)
        for index, (right, below, forwards) in enumerate(axes.astype(np.float32)):
            directions[:, index] = across * right + down * below + forwards
        return directions  # type: ignore[return-value]  # 32 bits are enough here

    @cached_property
    def columns(self) -> tuple[float, float]:
        """The minimum and maximum x at z = 1 of all pixels."""
        across, _ = self.slopes
        return float(across.min()), float(across.max())

    @cached_property
    def rows(self) -> tuple[float, float]:
        """The minimum and maximum y at z = 1 of all pixels."""
        _, down = self.slopes
        return float(down.min()), float(down.max())

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """The x and y at z = 1 of each pixel, both of shape (height * width,), float32."""
        across, down, _ = np.ascontiguousarray(self.rays.T, dtype=np.float32)
        return across, down

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
        """The optics of a pinhole camera whose image covers the image of this camera."""
        if self.is_pinhole:
            return self
        x, y = self.rays[:, 0], self.rays[:, 1]
        focal = max(self.fx, self.fy)
        left, right, top, bottom = (
            min(focal * reach + 1.0, _LARGEST * size)
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
        """The column and row in the image of `pinhole` of each pixel, as fractional pixel indices."""
        hole = self.pinhole
        return self.rays[:, 0] * hole.fx + hole.cx - 0.5, self.rays[:, 1] * hole.fy + hole.cy - 0.5

    def project(self, points: Array) -> Array:
        """Return the columns and rows in pixels, shape (n, 2), of points, shape (n, 3) with z > 0."""
        x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
        if self.distortion is not None:
            x, y = distort(self.distortion, x, y)
        placed: Array = np.stack([x * self.fx + self.cx, y * self.fy + self.cy], axis=-1)
        return placed


def optics_of(camera: Camera) -> Optics:
    """Return the optics of an SDF camera."""
    width, height = max(camera.image.width, 1), max(camera.image.height, 1)
    clip = camera.clip
    nearest = max(clip.near, 1e-3)
    farthest = max(clip.far, nearest * 2)
    given, lens = camera.distortion, camera.intrinsics
    lossy = given is not None and any((given.k1, given.k2, given.k3, given.p1, given.p2))
    focal = width / (2 * tan(min(max(camera.horizontal_fov, 1e-3), 3.1) / 2))
    if lens is not None and lens.fx > 0 and lens.fy > 0:
        place = lens.fx, lens.fy, lens.cx, lens.cy
    else:
        place = focal, focal, width / 2, height / 2
    return Optics(width, height, *place, nearest, farthest, given if lossy else None)


def distort(lens: Distortion, x: Array, y: Array) -> tuple[Array, Array]:
    """Return x and y at z = 1 after the distortion of a lens."""
    square = x * x + y * y
    radial = 1 + square * (lens.k1 + square * (lens.k2 + square * lens.k3))
    across = x * radial + 2 * lens.p1 * x * y + lens.p2 * (square + 2 * x * x)
    down = y * radial + lens.p1 * (square + 2 * y * y) + 2 * lens.p2 * x * y
    return across, down


def undistorted(lens: Distortion, x: Array, y: Array) -> tuple[Array, Array]:
    """Return x and y at z = 1 before the distortion of a lens, found by fixed-point iteration.

    The arguments are returned where the iteration does not converge.
    """
    across, down = x.copy(), y.copy()
    for _ in range(_TURNS):
        there = distort(lens, across, down)
        across, down = across + (x - there[0]), down + (y - there[1])
    wide = (np.abs(across) < 10) & (np.abs(down) < 10)  # The comparison is false for NaN.
    return np.where(wide, across, x), np.where(wide, down, y)
