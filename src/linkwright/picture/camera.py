"""Views of a scene, and cameras that fit a scene into an image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import radians

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.exact_angles import sine_and_cosine
from linkwright.geometry.single import Vector3, add_vectors, cross, scaled
from linkwright.picture.vectors import along

HALF_FOV_TANGENT = 0.22
"""The tangent of half the field of view along the shorter side, for perspective cameras."""
_MARGIN_FACTOR = 1.16
"""The ratio of the image's size to the size of the content that must be visible."""
_MIN_EXTENT = 1e-6
"""The width of the visible area in m if the scene is a single point."""


@dataclass(frozen=True, slots=True)
class View:
    """The direction from which a scene is seen.

    Attributes:
        azimuth: the angle in degrees from x, which is forward (REP 103), to the camera; counterclockwise from above.
        elevation: the angle in degrees of the camera above the ground, -90 to 90.
        perspective: whether distant parts are smaller.
    """

    azimuth: float
    elevation: float
    perspective: bool = True


VIEWS = {
    "iso": View(40.0, 28.0),
    "front": View(0.0, 0.0, perspective=False),
    "left": View(90.0, 0.0, perspective=False),
    "top": View(180.0, 90.0, perspective=False),
}
"""The named views. In the top view, x points up and y to the left, as on maps."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera outside of all bodies that it shows.

    Attributes:
        right: the direction of the image's right side.
        up: the direction of the image's upper side.
        toward: the direction from the scene to the camera.
        center: the components along these directions of the point that the middle of the image shows, in m.
        distance: the distance in m of the camera from this point; 0 for a camera without perspective.
        scale: the pixels per m at this point.
        size: the width and height of the image in pixels.
    """

    right: Vector3
    up: Vector3
    toward: Vector3
    center: Vector3
    distance: float
    scale: float
    size: tuple[int, int]

    def project(self, points: Array) -> tuple[Array, Array, Array]:
        """Return x and y in pixels from the upper left corner, and the nearness, of points (n, 3).

        The nearness is linear in the image over each plane, and larger for points nearer to the camera.
        """
        x = along(points, self.right) - self.center[0]
        y = along(points, self.up) - self.center[1]
        z = along(points, self.toward) - self.center[2]
        if self.distance:
            nearness = self.distance / (self.distance - z)
            x, y = x * nearness, y * nearness
        else:
            nearness = z
        return self.size[0] / 2 + x * self.scale, self.size[1] / 2 - y * self.scale, nearness

    def points_at(self, x: Array, y: Array, offset_toward: Array) -> Array:
        """Return the points that are visible at pixels, shape (n, 3): the inverse of `project`.

        Args:
            x: the pixels from the left.
            y: the pixels from the upper side.
            offset_toward: the distance of each point from `center` along `toward`, in m.
        """
        size = (self.distance - offset_toward) / self.distance if self.distance else np.ones_like(offset_toward)
        across = (x - self.size[0] / 2) / self.scale * size + self.center[0]
        upward = (self.size[1] / 2 - y) / self.scale * size + self.center[1]
        toward = offset_toward + self.center[2]
        coordinates = [
            across * self.right[axis] + upward * self.up[axis] + toward * self.toward[axis] for axis in range(3)
        ]
        return np.stack(coordinates, axis=1)

    def points_on_plane(self, height: float, x: Array, y: Array) -> Array:
        """Return the points at which the rays of pixels meet a horizontal plane, shape (n, 3).

        Args:
            height: z of the plane in m.
            x: the pixels from the left.
            y: the pixels from the upper side.
        """
        across = (x - self.size[0] / 2) / self.scale
        upward = (self.size[1] / 2 - y) / self.scale
        base = self._combine(*self.center)
        start = [base[axis] + across * self.right[axis] + upward * self.up[axis] for axis in range(3)]
        if self.distance:
            viewpoint = add_vectors(base, scaled(self.toward, self.distance))
            direction = [start[axis] - viewpoint[axis] for axis in range(3)]
        else:
            viewpoint, direction = None, [np.full(len(x), -component) for component in self.toward]
        with np.errstate(divide="ignore", invalid="ignore"):
            factor = (height - start[2]) / direction[2]
            is_ahead = (factor > -1.0) if viewpoint is not None else np.isfinite(factor)
            points = np.stack([start[axis] + factor * direction[axis] for axis in range(3)], axis=1)
        points[~is_ahead] = np.nan
        return points

    def _combine(self, right: float, up: float, toward: float) -> Vector3:
        parts = (scaled(self.right, right), scaled(self.up, up), scaled(self.toward, toward))
        return add_vectors(add_vectors(parts[0], parts[1]), parts[2])


def fit_camera(view: View, size: tuple[int, int], points: Sequence[Array]) -> Camera:
    """Return the camera that shows all points at the largest possible size.

    Args:
        view: the direction of the camera.
        size: the width and height of the image in pixels.
        points: arrays of points in m, each of shape (n, 3), with one point at least.
    """
    right, up, toward = compute_camera_axes(view)
    x, y, z = (np.concatenate([along(array, axis) for array in points]) for axis in (right, up, toward))
    width, height = size
    if not view.perspective:
        extents = [max(float(values.max() - values.min()), _MIN_EXTENT) for values in (x, y)]
        middle = [float(values.max() + values.min()) / 2 for values in (x, y)]
        scale = min(width / extents[0], height / extents[1]) / _MARGIN_FACTOR
        return Camera(right, up, toward, (middle[0], middle[1], float(z.max())), 0.0, scale, size)
    depth = float(z.max())
    z = z - depth
    shorter = min(width, height)
    tangents = [HALF_FOV_TANGENT * side / shorter / _MARGIN_FACTOR for side in (width, height)]
    center, distances = [], []
    for values, tangent in zip((x, y), tangents, strict=True):
        # All points are between two planes through the camera: |value - center| <= tangent * (distance - z).
        upper, lower = float((values + tangent * z).max()), float((tangent * z - values).max())
        center.append((upper - lower) / 2)
        distances.append(max(upper + lower, _MIN_EXTENT) / 2 / tangent)
    distance = max(distances)
    return Camera(
        right, up, toward, (center[0], center[1], depth), distance, shorter / 2 / (HALF_FOV_TANGENT * distance), size
    )


def compute_camera_axes(view: View) -> tuple[Vector3, Vector3, Vector3]:
    """Return the unit vectors that point right, up and toward the camera."""
    sine, cosine = sine_and_cosine(radians(view.azimuth))
    sine_up, cosine_up = sine_and_cosine(radians(view.elevation))
    toward = (cosine_up * cosine, cosine_up * sine, sine_up)
    right = (-sine, cosine, 0.0)
    return right, cross(toward, right), toward
