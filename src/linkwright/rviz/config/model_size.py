"""Sizes of grid and axes for a robot, because RViz's defaults do not fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

_RVIZ_AXIS = 0.2
"""Length of an axis of the TF display at Marker Scale 1, m."""
_LARGEST_FOCAL_SHAPE = 0.05


@dataclass(frozen=True, slots=True)
class ModelSize:
    """Lengths of a robot, m.

    Attributes:
        diagonal: the diagonal of its bounding box.
        spacing: from a link's frame to that of its parent, for most links.
    """

    diagonal: float
    spacing: float

    @property
    def distance(self) -> float:
        """The distance from which all of it is visible, until a page has measured its meshes, m."""
        return _rounded(2.0 * self.diagonal)

    @property
    def marker_scale(self) -> float:
        """The scale of TF's axes at which they are visible beside the links and do not cover them."""
        axis = min(max(self.spacing / 2, self.diagonal / 40), self.diagonal / 10)
        return _rounded(axis / _RVIZ_AXIS)

    @property
    def focal_shape(self) -> float:
        """Diameter of the disc at the focal point, m; RViz's default for robots that are large enough."""
        return min(_LARGEST_FOCAL_SHAPE, _rounded(self.diagonal / 15))

    @property
    def cell(self) -> float:
        """The grid's cell size, m: a power of ten; ten cells are wider than the robot, but one is not much wider."""
        return float(10.0 ** math.floor(math.log10(self.diagonal * 1.5)))


def _rounded(length: float) -> float:
    """Return a length rounded to two digits, as a user would type it."""
    return float(f"{length:.2g}")
