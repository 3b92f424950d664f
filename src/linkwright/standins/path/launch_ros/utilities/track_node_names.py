"""Stands in for ``launch_ros.utilities.track_node_names``."""

from linkwright.launch.ros import add_node_name, get_node_name_count
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["add_node_name", "get_node_name_count"]
