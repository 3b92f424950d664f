"""Registration of the conversions of ros2_numpy."""

from __future__ import annotations


def register() -> None:
    """Register all conversions by importing their modules."""
    from linkwright.standins.numpy_api import clouds, geometry, grids, images
