"""Stands in for ``launch_ros.actions.node``."""

from linkwright.launch.ros import Node
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Node"]
