"""Stands in for ``launch.events.include_launch_description``."""

from linkwright.launch.events import IncludeLaunchDescription

__all__ = ["IncludeLaunchDescription"]
