"""Stands in for ``launch_ros.descriptions.composable_lifecycle_node``."""

from linkwright.launch.ros import ComposableLifecycleNode
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ComposableLifecycleNode"]
