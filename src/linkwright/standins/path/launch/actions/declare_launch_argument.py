"""Stands in for ``launch.actions.declare_launch_argument``."""

from linkwright.launch.actions import DeclareLaunchArgument
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["DeclareLaunchArgument"]
