"""Stands in for ``launch_param_builder.utils``."""

from linkwright.launch.moveit import (
    ParameterBuilderFileNotFoundError,
    ParameterValueType,
    get_path,
    load_file,
    load_xacro,
    load_yaml,
)

__all__ = [
    "ParameterBuilderFileNotFoundError",
    "ParameterValueType",
    "get_path",
    "load_file",
    "load_xacro",
    "load_yaml",
]
