"""Stands in for ``launch_ros.event_handlers.on_state_transition``."""

from linkwright.launch.ros import OnStateTransition

__all__ = ["OnStateTransition"]
