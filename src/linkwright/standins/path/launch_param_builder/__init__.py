"""Stands in for ``launch_param_builder``."""

from linkwright.launch.moveit import (
    ParameterBuilder,
    ParameterBuilderFileNotFoundError,
    ParameterValueType,
    get_path,
    load_file,
    load_xacro,
    load_yaml,
)

__all__ = [
    "ParameterBuilder",
    "ParameterBuilderFileNotFoundError",
    "ParameterValueType",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
]
