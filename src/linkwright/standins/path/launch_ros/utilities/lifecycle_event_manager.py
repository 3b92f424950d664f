"""Stands in for ``launch_ros.utilities.lifecycle_event_manager``."""

from linkwright.launch.ros import LifecycleEventManager

__all__ = ["LifecycleEventManager"]
