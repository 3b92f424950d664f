"""Stands in for ``moveit_configs_utils.launch_utils``."""

from linkwright.launch.moveit import DeclareBooleanLaunchArg, add_debuggable_node

__all__ = ["DeclareBooleanLaunchArg", "add_debuggable_node"]
