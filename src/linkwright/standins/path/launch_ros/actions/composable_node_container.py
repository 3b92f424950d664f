"""Stands in for ``launch_ros.actions.composable_node_container``."""

from linkwright.launch.ros import ComposableNodeContainer
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ComposableNodeContainer"]
