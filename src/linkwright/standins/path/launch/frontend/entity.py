"""Stands in for ``launch.frontend.entity``."""

from linkwright.launch.frontend.entity import Entity

__all__ = ["Entity"]
