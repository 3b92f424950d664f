"""Stands in for ``launch.actions.include_scoped_launch_description``."""

from linkwright.launch.actions import IncludeScopedLaunchDescription

__all__ = ["IncludeScopedLaunchDescription"]
