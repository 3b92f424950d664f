"""Stands in for ``launch.actions.include_launch_description``."""

from linkwright.launch.actions import IncludeLaunchDescription
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["IncludeLaunchDescription"]
