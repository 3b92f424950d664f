"""Stands in for ``launch.launch_description``."""

from linkwright.launch.description import LaunchDescription
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchDescription"]
