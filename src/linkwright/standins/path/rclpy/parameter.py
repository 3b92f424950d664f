"""Stands in for ``rclpy.parameter``."""

from linkwright.graph.parameters.parameter import PARAMETER_SEPARATOR_STRING, Parameter, parameter_value_to_python
from linkwright.standins.rclpy_api.imported_names import imported_there as __getattr__
from linkwright.standins.rclpy_api.parameters import get_parameter_value, parameter_dict_from_yaml_file

__all__ = [
    "PARAMETER_SEPARATOR_STRING",
    "Parameter",
    "get_parameter_value",
    "parameter_dict_from_yaml_file",
    "parameter_value_to_python",
]
