"""Stands in for ``launch_ros.parameter_descriptions``."""

from linkwright.launch.ros import Parameter, ParameterFile, ParameterValue

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]
