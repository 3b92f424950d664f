"""Stands in for ``launch_ros.events.matchers``."""

from linkwright.launch.ros import matches_node_name

__all__ = ["matches_node_name"]
