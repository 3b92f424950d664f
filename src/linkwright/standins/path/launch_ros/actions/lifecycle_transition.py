"""Stands in for ``launch_ros.actions.lifecycle_transition``."""

from linkwright.launch.ros import LifecycleTransition

__all__ = ["LifecycleTransition"]
