"""Stands in for ``launch_ros.descriptions.composable_node``."""

from linkwright.launch.ros import ComposableNode
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ComposableNode"]
