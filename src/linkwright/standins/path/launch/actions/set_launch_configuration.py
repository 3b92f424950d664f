"""Stands in for ``launch.actions.set_launch_configuration``."""

from linkwright.launch.actions import SetLaunchConfiguration
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetLaunchConfiguration"]
