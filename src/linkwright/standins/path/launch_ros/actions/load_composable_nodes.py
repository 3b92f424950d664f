"""Stands in for ``launch_ros.actions.load_composable_nodes``."""

from linkwright.launch.ros import LoadComposableNodes, get_composable_node_load_request
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LoadComposableNodes", "get_composable_node_load_request"]
