"""Ambient occlusion: less light reaches corners and narrow gaps between parts.

For each pixel, surrounding points of the image are examined. Points above the pixel's tangent plane block light.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.exact_angles import regular_polygon
from linkwright.picture.camera import Camera
from linkwright.picture.edges import sum_over_boxes
from linkwright.picture.vectors import Floats

_DIRECTION_COUNT = 10
_RINGS = (0.10, 0.28, 0.56, 1.0)
"""The distances of the examined points, relative to the maximum distance."""
_REACH = 0.085
"""The maximum distance, relative to the shorter side of the image."""
_BIAS = 0.12
"""The minimum sine of the angle above the tangent plane at which a point blocks light. Round surfaces stay bright."""
_STRENGTH = 2.6
_BLUR = 2
"""The radius in pixels of the blur that hides the pattern of the examined points."""
_STEPS = 4096
_MIN_LIGHT = 0.30
"""The fraction of the light that remains in the deepest corner."""


def compute_occlusion_reach(camera: Camera) -> int:
    """Return the number of pixels around a pixel that its light depends on."""
    return _compute_examined_reach(camera) + _BLUR


def _compute_examined_reach(camera: Camera) -> int:
    return max(2, round(_REACH * min(camera.size)))


def compute_ambient_light(depth: Floats, normals: Floats, is_seen: NDArray[np.bool_], camera: Camera) -> Floats:
    """Return the fraction of the light that reaches each pixel, from 0 to 1.

    Args:
        depth: the component along the camera's `toward` of the surface at each pixel, in m, shape (rows, columns).
        normals: the unit normals of the surface along `right`, `up` and `toward`, shape (3, rows, columns).
        is_seen: whether a surface is seen, shape (rows, columns).
        camera: the camera that renders the image.
    """
    meters = _compute_meters_per_pixel(depth, camera)
    reach = float(_compute_examined_reach(camera))
    blocked = np.zeros(depth.shape, np.float32)
    for ring, part in enumerate(_RINGS):
        for direction in range(_DIRECTION_COUNT):
            cosine, sine = regular_polygon(_DIRECTION_COUNT * len(_RINGS))[direction * len(_RINGS) + ring]
            shift = round(cosine * part * reach), round(sine * part * reach)
            if shift != (0, 0):
                _add_blocked(blocked, depth, normals, is_seen, meters, shift, reach)
    light = 1.0 - blocked * (_STRENGTH / (_DIRECTION_COUNT * len(_RINGS)))
    steps = np.where(is_seen, np.rint(np.maximum(light, np.float32(_MIN_LIGHT)) * _STEPS), 0.0).astype(np.int64)
    count = np.maximum(sum_over_boxes(is_seen.astype(np.int64), _BLUR), 1)
    ambient: Floats = (sum_over_boxes(steps, _BLUR) / (count * _STEPS)).astype(np.float32)
    return ambient


def _compute_meters_per_pixel(depth: Floats, camera: Camera) -> Floats:
    if not camera.distance:
        return np.full(depth.shape, 1.0 / camera.scale, np.float32)
    meters: Floats = (camera.distance - depth) * np.float32(1.0 / (camera.scale * camera.distance))
    return meters


def _add_blocked(
    blocked: Floats,
    depth: Floats,
    normals: Floats,
    is_seen: NDArray[np.bool_],
    meters: Floats,
    shift: tuple[int, int],
    reach: float,
) -> None:
    """Add to `blocked` the light blocked by the points `shift` (right, down) pixels away."""
    across, down = shift
    rows, columns = depth.shape
    inner = (slice(max(0, -down), min(rows, rows - down)), slice(max(0, -across), min(columns, columns - across)))
    shifted = (slice(max(0, down), min(rows, rows + down)), slice(max(0, across), min(columns, columns + across)))
    if inner[0].stop <= inner[0].start or inner[1].stop <= inner[1].start:
        return
    size = meters[inner]
    x, y = size * float(across), size * float(-down)
    z = depth[shifted] - depth[inner]
    square = x * x + y * y + z * z
    height = normals[0][inner] * x + normals[1][inner] * y + normals[2][inner] * z
    sine = height / np.sqrt(np.maximum(square, np.float32(1e-20)))
    limit = size * float(1.6 * reach)
    nearness = np.maximum(1.0 - square / (limit * limit), np.float32(0.0))
    gain = np.maximum(sine - np.float32(_BIAS), np.float32(0.0)) * nearness
    blocked[inner] += np.where(is_seen[shifted], gain, np.float32(0.0))
