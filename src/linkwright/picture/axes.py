"""Draw the axes of frames over an image."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.picture.bodies import Axes, Color
from linkwright.picture.camera import Camera
from linkwright.picture.lines import draw_lines
from linkwright.picture.vectors import Floats

_COLORS: tuple[Color, Color, Color] = ((0.72, 0.02, 0.02), (0.02, 0.34, 0.04), (0.03, 0.09, 0.78))
"""The light of x, y and z."""
_LINE_RADIUS_PX, _HALO_RADIUS_PX = 1.1, 2.1
"""Half the width of an axis, and the radius of the bright area around it."""


def draw_axes(colors: Floats, alpha: Floats, axes: Sequence[Axes], camera: Camera) -> None:
    """Draw the axes of frames over everything: x in red, y in green and z in blue.

    Args:
        colors: the light of the pixels multiplied by their opacity, shape (height, width, 3), which is changed.
        alpha: the opacity of the pixels, shape (height, width), which is changed.
        axes: the axes.
        camera: the camera of the image.
    """
    for frame in axes:
        x, y, nearness = camera.project(make_points(frame))
        ends = np.stack([x, y], axis=1)
        for axis in np.argsort(nearness[1:], kind="stable").tolist():
            line = np.stack([ends[0], ends[axis + 1]])[np.newaxis]
            draw_lines(colors, alpha, line, _LINE_RADIUS_PX, _HALO_RADIUS_PX, _COLORS[axis])


def make_points(axes: Axes) -> Array:
    """Return the origin and the ends of the axes in m, shape (4, 3)."""
    origin = np.array(axes.frame.position)
    rotation = np.array(axes.frame.rotation)
    points: Array = np.stack([origin, *(origin + rotation[:, axis] * axes.length for axis in range(3))])
    return points
