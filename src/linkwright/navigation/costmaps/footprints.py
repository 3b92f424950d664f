"""Footprints, the outlines of robots on the floor in the frame of the robot.

Source: nav2_costmap_2d (``footprint.hpp``).
"""

from __future__ import annotations

from ast import literal_eval
from math import ceil, hypot, pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

Footprint = NDArray[np.float64]
"""Corners in the frame of the robot, in meters, of shape (corners, 2)."""

_CIRCLE_CORNERS = 16
_MIN_CORNERS = 3


class BadFootprintError(ValueError):
    """Raised when a footprint parameter is not valid.

    The message gives the reason.
    """


def make_circle(radius: float) -> Footprint:
    """Return the footprint of a round robot: a regular polygon of 16 corners.

    `radius` is in meters.
    """
    angles = np.arange(_CIRCLE_CORNERS) * (2.0 * pi / _CIRCLE_CORNERS)
    corners: Footprint = radius * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
    return corners


def parse_footprint(text: str) -> Footprint:
    """Parse a footprint parameter, such as ``[[0.2, 0.1], [0.2, -0.1], [-0.2, 0.0]]``.

    Raises:
        BadFootprintError: the parameter is not a list of three or more points.
    """
    try:
        value: Any = literal_eval(text.strip())
        corners: Footprint = np.array(value, np.float64)
    except (TypeError, ValueError, SyntaxError):
        raise BadFootprintError(f"'{text}' is not a list of points such as [[x1, y1], [x2, y2], [x3, y3]]") from None
    if corners.ndim != 2 or corners.shape[1] != 2 or not np.isfinite(corners).all():
        raise BadFootprintError(f"'{text}' is not a list of points such as [[x1, y1], [x2, y2], [x3, y3]]")
    if len(corners) < _MIN_CORNERS:
        raise BadFootprintError(f"a footprint needs at least three corners, but '{text}' has {len(corners)}")
    return corners


def pad_footprint(footprint: Footprint, padding: float) -> Footprint:
    """Return a footprint with its corners moved away from both axes by `padding` meters."""
    padded_corners: Footprint = footprint + padding * np.sign(footprint)
    return padded_corners


def compute_radii(footprint: Footprint) -> tuple[float, float]:
    """Return the radii of the inscribed and circumscribed circles of a footprint, in meters.

    Both circles are centered at the origin of the robot.
    """
    next_corners = np.roll(footprint, -1, axis=0)
    edges = next_corners - footprint
    squared_lengths = np.maximum((edges**2).sum(axis=1), np.finfo(float).tiny)
    fractions = np.clip(-(footprint * edges).sum(axis=1) / squared_lengths, 0.0, 1.0)
    nearest_points = footprint + fractions[:, None] * edges
    inscribed_radius = float(np.hypot(nearest_points[:, 0], nearest_points[:, 1]).min())
    return inscribed_radius, float(np.hypot(footprint[:, 0], footprint[:, 1]).max())


def make_outline(footprint: Footprint, spacing: float) -> NDArray[np.float64]:
    """Return points along the outline of a footprint, at most `spacing` meters apart.

    The points have shape (points, 2).
    """
    edge_points = []
    for corner, next_corner in zip(footprint, np.roll(footprint, -1, axis=0), strict=True):
        point_count = max(1, ceil(hypot(*(next_corner - corner)) / spacing))
        edge_points.append(corner + (np.arange(point_count) / point_count)[:, None] * (next_corner - corner))
    return np.concatenate(edge_points)


def place_footprint(footprint: Footprint, x: float, y: float, yaw: float) -> Footprint:
    """Return the corners of a footprint at a pose, in the frame of the pose."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    corners: Footprint = footprint @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y)
    return corners
