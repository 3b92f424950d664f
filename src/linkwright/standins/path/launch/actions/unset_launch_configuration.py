"""Stands in for ``launch.actions.unset_launch_configuration``."""

from linkwright.launch.actions import UnsetLaunchConfiguration
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["UnsetLaunchConfiguration"]
