"""Stands in for ``launch.actions.include_launch_description``."""

from linkwright.launch.actions import IncludeLaunchDescription

__all__ = ["IncludeLaunchDescription"]
