"""Stands in for ``moveit_configs_utils``."""

from linkwright.launch.moveit import MoveItConfigs, MoveItConfigsBuilder

__all__ = ["MoveItConfigs", "MoveItConfigsBuilder"]
