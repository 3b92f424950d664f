"""Stands in for ``launch.actions.declare_boolean_launch_argument``."""

from linkwright.launch.actions import DeclareBooleanLaunchArgument

__all__ = ["DeclareBooleanLaunchArgument"]
