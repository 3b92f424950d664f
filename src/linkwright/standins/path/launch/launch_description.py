"""Stands in for ``launch.launch_description``."""

from linkwright.launch.description import LaunchDescription

__all__ = ["LaunchDescription"]
