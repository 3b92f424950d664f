"""Stands in for ``moveit_configs_utils.substitutions``."""

from linkwright.launch.moveit import Xacro

__all__ = ["Xacro"]
