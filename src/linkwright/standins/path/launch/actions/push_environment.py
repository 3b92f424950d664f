"""Stands in for ``launch.actions.push_environment``."""

from linkwright.launch.actions import PushEnvironment
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PushEnvironment"]
