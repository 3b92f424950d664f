"""Stands in for ``launch.actions.pop_environment``."""

from linkwright.launch.actions import PopEnvironment
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PopEnvironment"]
