"""Stands in for ``launch_ros.events.lifecycle.state_transition``."""

from linkwright.launch.ros import StateTransition

__all__ = ["StateTransition"]
