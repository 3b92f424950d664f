"""Stands in for ``moveit_configs_utils.substitutions.xacro``."""

from linkwright.launch.moveit import Xacro

__all__ = ["Xacro"]
