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
"""Corners in the frame of the robot, in metres, of shape (corners, 2)."""

_CORNERS_OF_A_CIRCLE = 16
_LEAST_CORNERS = 3


class BadFootprintError(ValueError):
    """Raised when a footprint parameter is not valid; the message gives the reason."""


def circle(radius: float) -> Footprint:
    """Return the footprint of a round robot: a regular polygon of 16 corners.

    `radius` is in metres.
    """
    angles = np.arange(_CORNERS_OF_A_CIRCLE) * (2.0 * pi / _CORNERS_OF_A_CIRCLE)
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
    if len(corners) < _LEAST_CORNERS:
        raise BadFootprintError(f"a footprint needs at least three corners, but '{text}' has {len(corners)}")
    return corners


def pad_footprint(footprint: Footprint, padding: float) -> Footprint:
    """Return a footprint whose corners are moved away from both axes by `padding` metres."""
    larger: Footprint = footprint + padding * np.sign(footprint)
    return larger


def radii(footprint: Footprint) -> tuple[float, float]:
    """Return the radii of the inscribed and circumscribed circles of a footprint, in metres.

    Both circles are centred at the origin of the robot.
    """
    following = np.roll(footprint, -1, axis=0)
    along = following - footprint
    length = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip(-(footprint * along).sum(axis=1) / length, 0.0, 1.0)
    nearest = footprint + share[:, None] * along
    inner = float(np.hypot(nearest[:, 0], nearest[:, 1]).min())
    return inner, float(np.hypot(footprint[:, 0], footprint[:, 1]).max())


def outline(footprint: Footprint, spacing: float) -> NDArray[np.float64]:
    """Return points along the outline of a footprint, of shape (points, 2), at most `spacing` metres apart."""
    parts = []
    for corner, following in zip(footprint, np.roll(footprint, -1, axis=0), strict=True):
        steps = max(1, ceil(hypot(*(following - corner)) / spacing))
        parts.append(corner + (np.arange(steps) / steps)[:, None] * (following - corner))
    return np.concatenate(parts)


def place_footprint(footprint: Footprint, x: float, y: float, yaw: float) -> Footprint:
    """Return the corners of a footprint at a pose, in the frame in which the pose is given."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    turned: Footprint = footprint @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y)
    return turned
