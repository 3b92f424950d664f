"""Stands in for ``launch_ros.utilities.namespace_utils``."""

from linkwright.launch.ros import is_namespace_absolute, is_root_namespace, make_namespace_absolute, prefix_namespace

__all__ = ["is_namespace_absolute", "is_root_namespace", "make_namespace_absolute", "prefix_namespace"]
