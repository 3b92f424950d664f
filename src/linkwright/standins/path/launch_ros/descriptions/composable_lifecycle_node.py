"""Stands in for ``launch_ros.descriptions.composable_lifecycle_node``."""

from linkwright.launch.ros import ComposableLifecycleNode

__all__ = ["ComposableLifecycleNode"]
