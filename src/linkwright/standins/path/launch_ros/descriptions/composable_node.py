"""Stands in for ``launch_ros.descriptions.composable_node``."""

from linkwright.launch.ros import ComposableNode

__all__ = ["ComposableNode"]
