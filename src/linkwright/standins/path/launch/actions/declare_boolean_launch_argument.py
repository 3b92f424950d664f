"""Stands in for ``launch.actions.declare_boolean_launch_argument``."""

from linkwright.launch.actions import DeclareBooleanLaunchArgument
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["DeclareBooleanLaunchArgument"]
