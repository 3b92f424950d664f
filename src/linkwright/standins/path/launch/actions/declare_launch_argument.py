"""Stands in for ``launch.actions.declare_launch_argument``."""

from linkwright.launch.actions import DeclareLaunchArgument

__all__ = ["DeclareLaunchArgument"]
