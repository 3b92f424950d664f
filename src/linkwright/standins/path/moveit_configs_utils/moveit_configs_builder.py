"""Stands in for ``moveit_configs_utils.moveit_configs_builder``."""

from linkwright.launch.moveit import (
    MoveItConfigs,
    MoveItConfigsBuilder,
    ParameterBuilder,
    ParameterBuilderFileNotFoundError,
    Xacro,
    load_xacro,
    load_yaml,
)

__all__ = [
    "MoveItConfigs",
    "MoveItConfigsBuilder",
    "ParameterBuilder",
    "ParameterBuilderFileNotFoundError",
    "Xacro",
    "load_xacro",
    "load_yaml",
]
