"""Stands in for ``launch.events.include_launch_description``."""

from linkwright.launch.events import IncludeLaunchDescription
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["IncludeLaunchDescription"]
