"""Stands in for ``launch.actions.reset_environment``."""

from linkwright.launch.actions import ResetEnvironment
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ResetEnvironment"]
