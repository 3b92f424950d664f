"""Stands in for ``launch_ros.actions.lifecycle_node``."""

from linkwright.launch.ros import LifecycleNode
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LifecycleNode"]
