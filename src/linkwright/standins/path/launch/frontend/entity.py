"""Stands in for ``launch.frontend.entity``."""

from linkwright.launch.frontend.entity import Entity
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Entity"]
