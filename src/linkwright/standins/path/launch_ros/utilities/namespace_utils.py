"""Stands in for ``launch_ros.utilities.namespace_utils``."""

from linkwright.launch.ros import is_namespace_absolute, is_root_namespace, make_namespace_absolute, prefix_namespace
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["is_namespace_absolute", "is_root_namespace", "make_namespace_absolute", "prefix_namespace"]
