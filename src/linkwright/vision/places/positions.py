"""Positions of detected objects in meters, from a depth image or the ground below them."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from linkwright.vision.places.camera import CameraModel, Floats

_INNER_FRACTION = 0.6
"""The central fraction of a box's width and height that shows mostly the object, not the background."""
_MIN_SURFACE_FRACTION = 0.25
"""The minimum fraction of the depths in the middle of a box that belong to the object's surface."""
_MIN_DEPTH_COUNT = 4
_MIN_GAP_M, _MIN_GAP_SHARE = 0.1, 0.05
"""Neighboring depths belong to different surfaces if they differ by more than this distance and this fraction."""
_MAX_FLAT_FRACTION = 0.1
"""The maximum depth of a flat surface, as a fraction of its width."""
_ROUND_ASPECT_RATIOS = (0.8, 1.25)
"""The range of width / height of the boxes of round objects. Such objects touch the ground below their center."""
_EDGE_PIXELS = 1.5
"""The distance from the lower edge of the image, in pixels, within which a box counts as cut off."""
_MIN_DESCENT = 0.01
"""The minimum descent of a ray, in meters per meter, at which its point on the ground is used."""


@dataclass(frozen=True, slots=True)
class ObjectPosition:
    """The position and size of an object.

    Attributes:
        center: x, y, z in meters, in the camera's optical frame.
        width, height, depth: the size in meters, along the image's x and y axes and along the optical axis.
    """

    center: tuple[float, float, float]
    width: float
    height: float
    depth: float


def position_from_depth(
    box: NDArray[np.floating],
    depths: Floats,
    camera: CameraModel,
    *,
    max_depth_difference: float = np.inf,
    max_depth: float = np.inf,
) -> ObjectPosition | None:
    """Return the position of an object from a depth image.

    The nearest surface in the middle of the box is used if it is large enough: behind an object there is always
    another surface, often a larger one. An object is assumed to be as deep as it is wide, unless its surface is flat.

    Args:
        box: left, top, right, bottom, in pixels of an image that is registered to the depth image and has the size of
            `camera`.
        depths: shape ``(rows, columns)``, meters along the view; NaN, infinite, 0 or negative where unknown.
        camera: the camera of the image with the box.
        max_depth_difference: the maximum difference in depth between the middle of the surface and a point of the
            object, meters.
        max_depth: the maximum depth that is used, meters.

    Returns:
        The position and size; None if there are too few depths.
    """
    rows, columns = depths.shape
    scale = np.array([columns / camera.width, rows / camera.height] * 2)
    scaled = np.asarray(box, np.float64) * scale
    inner_depths = _crop_depths(depths, _shrink_box(scaled, _INNER_FRACTION))
    valid_depths = inner_depths[np.isfinite(inner_depths) & (inner_depths > 0) & (inner_depths <= max_depth)]
    if len(valid_depths) < max(_MIN_DEPTH_COUNT, _MIN_SURFACE_FRACTION * _MIN_SURFACE_FRACTION * inner_depths.size):
        return None
    surface_start, surface_end = _find_nearest_surface(np.sort(valid_depths))
    depths_in_box = _crop_depths(depths, scaled)
    surface_depth = float(np.median(valid_depths[(valid_depths >= surface_start) & (valid_depths <= surface_end)]))
    surface = depths_in_box[
        (depths_in_box >= max(surface_start - _compute_min_gap(surface_start), surface_depth - max_depth_difference))
        & (depths_in_box <= min(surface_end + _compute_min_gap(surface_end), surface_depth + max_depth_difference))
    ]
    front = float(np.percentile(surface, 5))
    width, height = _compute_size(box, camera, front)
    thickness = float(np.percentile(surface, 95)) - front
    depth = width if thickness > _MAX_FLAT_FRACTION * width else thickness
    surface_depth = front + depth / 2
    width, height = _compute_size(box, camera, surface_depth)
    ray = camera.rays_from_pixels(np.array([[(box[0] + box[2]) / 2, (box[1] + box[3]) / 2]], np.float64))[0]
    return ObjectPosition(
        (float(ray[0]) * surface_depth, float(ray[1]) * surface_depth, surface_depth), width, height, depth
    )


def position_on_ground(
    box: NDArray[np.floating], camera: CameraModel, normal: Floats, height: float, *, max_distance: float = np.inf
) -> ObjectPosition | None:
    """Return the position of an object on the ground, from the lower edge of its box.

    An object is assumed to be as deep as it is wide. If its box is about square, the object touches the ground below
    its center, as a ball does. Any other object touches the ground with its front at the lower edge of the box.

    Args:
        box: left, top, right, bottom, pixels.
        camera: the camera of the image.
        normal: the ground's upward normal in the optical frame: shape ``(3,)``, length 1.
        height: the height of the camera above the ground, meters.
        max_distance: the maximum distance along the viewing ray, meters; beyond it the result is None.

    Returns:
        The position and size; None if the box ends at or above the horizon, or at the lower edge of the image.
    """
    left, _, right, bottom = (float(edge) for edge in box)
    if bottom >= camera.height - _EDGE_PIXELS:
        return None
    ray = camera.rays_from_pixels(np.array([[(left + right) / 2, bottom]]))[0]
    descent = -float(ray @ normal)
    if descent < _MIN_DESCENT or height <= 0 or height / descent > max_distance:
        return None
    position = ray * (height / descent)
    width, object_height = _compute_size(box, camera, float(position[2]))
    if not _ROUND_ASPECT_RATIOS[0] <= width / object_height <= _ROUND_ASPECT_RATIOS[1]:
        horizontal = ray + descent * normal
        position = position + horizontal * (width / 2 / max(float(np.linalg.norm(horizontal)), 1e-9))
        width, object_height = _compute_size(box, camera, float(position[2]))
    center = position + normal * (object_height / 2)
    return ObjectPosition((float(center[0]), float(center[1]), float(center[2])), width, object_height, width)


def _compute_size(box: NDArray[np.floating], camera: CameraModel, depth: float) -> tuple[float, float]:
    return float(box[2] - box[0]) / camera.fx * depth, float(box[3] - box[1]) / camera.fy * depth


def _shrink_box(box: Floats, share: float) -> Floats:
    center, half_size = (box[:2] + box[2:]) / 2, (box[2:] - box[:2]) / 2
    return np.concatenate([center - half_size * share, center + half_size * share])


def _crop_depths(depths: Floats, box: Floats) -> Floats:
    rows, columns = depths.shape
    left, top = max(0, floor(box[0])), max(0, floor(box[1]))
    right, bottom = min(columns, ceil(box[2])), min(rows, ceil(box[3]))
    return depths[top : max(top, bottom), left : max(left, right)]


def _compute_min_gap(depth: float) -> float:
    return max(_MIN_GAP_M, _MIN_GAP_SHARE * depth)


def _find_nearest_surface(depths: Floats) -> tuple[float, float]:
    """Return the depth range of the nearest sufficiently large surface, from sorted depths."""
    gaps = np.diff(depths) > np.maximum(_MIN_GAP_M, _MIN_GAP_SHARE * depths[:-1])
    surfaces = np.split(depths, np.flatnonzero(gaps) + 1)
    for surface in surfaces:
        if len(surface) >= _MIN_SURFACE_FRACTION * len(depths):
            return float(surface[0]), float(surface[-1])
    largest = max(surfaces, key=len)
    return float(largest[0]), float(largest[-1])
