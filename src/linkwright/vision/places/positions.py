"""Positions of detected objects in metres, from a depth image or from the ground below them."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.places.camera import CameraModel, Floats

_INNER = 0.6
"""The central share of a box's width and height that most likely shows the object and not the background."""
_LEAST_SHARE = 0.25
"""The least part of the depths in the middle of a box that the object's surface has."""
_LEAST_DEPTHS = 4
_GAP_METRES, _GAP_SHARE = 0.1, 0.05
"""Two surfaces are apart where neighbouring depths differ by more than this, and by more than this share of them."""
_FLAT = 0.1
"""A surface whose depths differ by less than this share of its width is flat."""
_SQUARE = (0.8, 1.25)
"""Width by height of boxes of objects that are as round as balls, which touch the ground below their middle."""
_EDGE_PIXELS = 1.5
_LEAST_FALL = 0.01
"""A ray that falls by less than this, metres a metre, does not determine where it meets the ground."""


@dataclass(frozen=True, slots=True)
class Place:
    """The position and size of an object.

    Attributes:
        centre: x, y, z in metres, in the camera's optical frame.
        width, height, depth: the size along the image's x and y, and along the view, metres.
    """

    centre: tuple[float, float, float]
    width: float
    height: float
    depth: float


def place_by_depth(
    box: NDArray[np.floating], depths: Floats, camera: CameraModel, *, spread: float = np.inf, farthest: float = np.inf
) -> Place | None:
    """Return the position of an object from a depth image.

    The nearest surface in the middle of the box counts, if it is more than an edge, because behind an object there is
    always another surface, often a larger one. An object is assumed to be as deep as it is wide, unless its surface is
    flat.

    Args:
        box: left, top, right, bottom, in pixels of an image that is registered to the depth image and has the size of
            `camera`.
        depths: shape ``(rows, columns)``, metres along the view; NaN, infinite, 0 or negative where unknown.
        camera: the camera of the image with the box.
        spread: the largest difference in depth from the middle of the surface to a point of the object, metres.
        farthest: greater depths are ignored, metres.

    Returns:
        None if there are too few depths.
    """
    rows, columns = depths.shape
    scale = np.array([columns / camera.width, rows / camera.height] * 2)
    scaled = np.asarray(box, np.float64) * scale
    inner = _cut(depths, _shrunk(scaled, _INNER))
    known = inner[np.isfinite(inner) & (inner > 0) & (inner <= farthest)]
    if len(known) < max(_LEAST_DEPTHS, _LEAST_SHARE * _LEAST_SHARE * inner.size):
        return None
    nearest, last = _nearest_surface(np.sort(known))
    whole = _cut(depths, scaled)
    middle = float(np.median(known[(known >= nearest) & (known <= last)]))
    surface = whole[
        (whole >= max(nearest - _gap(nearest), middle - spread)) & (whole <= min(last + _gap(last), middle + spread))
    ]
    front = float(np.percentile(surface, 5))
    width, height = _size(box, camera, front)
    thick = float(np.percentile(surface, 95)) - front
    depth = width if thick > _FLAT * width else thick
    middle = front + depth / 2
    width, height = _size(box, camera, middle)
    ray = camera.rays(np.array([[(box[0] + box[2]) / 2, (box[1] + box[3]) / 2]], np.float64))[0]
    return Place((float(ray[0]) * middle, float(ray[1]) * middle, middle), width, height, depth)


def place_on_ground(
    box: NDArray[np.floating], camera: CameraModel, normal: Floats, height: float, *, farthest: float = np.inf
) -> Place | None:
    """Return the position of an object on the ground, from the lower edge of its box.

    An object is assumed to be as deep as it is wide. If its box is about square, the object touches the ground below
    its centre, as a ball does. Otherwise the box ends at the foot of the object's front.

    Args:
        box: left, top, right, bottom, pixels.
        camera: the camera of the image.
        normal: the ground's upward normal in the optical frame: shape ``(3,)``, length 1.
        height: the height of the camera above the ground, metres.
        farthest: no position is returned for objects farther away, metres along the view.

    Returns:
        None if the ground is not visible there: at the horizon and above, or below the image's edge.
    """
    left, _, right, bottom = (float(edge) for edge in box)
    if bottom >= camera.height - _EDGE_PIXELS:
        return None
    foot = camera.rays(np.array([[(left + right) / 2, bottom]]))[0]
    fall = -float(foot @ normal)
    if fall < _LEAST_FALL or height <= 0 or height / fall > farthest:
        return None
    at = foot * (height / fall)
    width, tall = _size(box, camera, float(at[2]))
    if not _SQUARE[0] <= width / tall <= _SQUARE[1]:
        ahead = foot + fall * normal
        at = at + ahead * (width / 2 / max(float(np.linalg.norm(ahead)), 1e-9))
        width, tall = _size(box, camera, float(at[2]))
    centre = at + normal * (tall / 2)
    return Place((float(centre[0]), float(centre[1]), float(centre[2])), width, tall, width)


def _size(box: NDArray[np.floating], camera: CameraModel, reach: float) -> tuple[float, float]:
    return float(box[2] - box[0]) / camera.fx * reach, float(box[3] - box[1]) / camera.fy * reach


def _shrunk(box: Floats, share: float) -> Floats:
    middle, half = (box[:2] + box[2:]) / 2, (box[2:] - box[:2]) / 2
    return np.concatenate([middle - half * share, middle + half * share])


def _cut(depths: Floats, box: Floats) -> Floats:
    rows, columns = depths.shape
    left, top = max(0, floor(box[0])), max(0, floor(box[1]))
    right, bottom = min(columns, ceil(box[2])), min(rows, ceil(box[3]))
    return depths[top : max(top, bottom), left : max(left, right)]


def _gap(depth: float) -> float:
    return max(_GAP_METRES, _GAP_SHARE * depth)


def _nearest_surface(known: Floats) -> tuple[float, float]:
    """Return the depth range of the nearest surface of sufficient size, from sorted depths."""
    gaps = np.diff(known) > np.maximum(_GAP_METRES, _GAP_SHARE * known[:-1])
    surfaces = np.split(known, np.flatnonzero(gaps) + 1)
    for surface in surfaces:
        if len(surface) >= _LEAST_SHARE * len(known):
            return float(surface[0]), float(surface[-1])
    largest = max(surfaces, key=len)
    return float(largest[0]), float(largest[-1])
