"""Stands in for ``launch_ros.events.matchers``."""

from linkwright.launch.ros import matches_node_name
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["matches_node_name"]
