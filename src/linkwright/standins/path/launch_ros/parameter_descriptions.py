"""Stands in for ``launch_ros.parameter_descriptions``."""

from linkwright.launch.ros import Parameter, ParameterFile, ParameterValue
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]
