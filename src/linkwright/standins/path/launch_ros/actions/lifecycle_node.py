"""Stands in for ``launch_ros.actions.lifecycle_node``."""

from linkwright.launch.ros import LifecycleNode

__all__ = ["LifecycleNode"]
