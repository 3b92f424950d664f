"""Stands in for ``launch_param_builder.launch_param_builder``."""

from linkwright.launch.moveit import ParameterBuilder

__all__ = ["ParameterBuilder"]
