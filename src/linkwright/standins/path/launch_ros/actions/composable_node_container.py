"""Stands in for ``launch_ros.actions.composable_node_container``."""

from linkwright.launch.ros import ComposableNodeContainer

__all__ = ["ComposableNodeContainer"]
