"""Stands in for ``launch.event_handlers.on_include_launch_description``."""

from linkwright.launch.event_handlers import OnIncludeLaunchDescription

__all__ = ["OnIncludeLaunchDescription"]
