"""Stands in for ``launch_ros.utilities.track_node_names``."""

from linkwright.launch.ros import add_node_name, get_node_name_count

__all__ = ["add_node_name", "get_node_name_count"]
