"""Stands in for ``launch_ros.event_handlers``."""

from linkwright.launch.ros import OnStateTransition

__all__ = ["OnStateTransition"]
