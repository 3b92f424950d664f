"""Stands in for ``launch_ros.events``."""

from launch_ros.events import lifecycle
from launch_ros.events.matchers import matches_node_name
from linkwright.standins.imported_names import submodules_of

__all__ = ["lifecycle", "matches_node_name"]

__getattr__ = submodules_of(__name__)
