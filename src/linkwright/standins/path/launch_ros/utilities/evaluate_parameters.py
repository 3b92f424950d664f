"""Stands in for ``launch_ros.utilities.evaluate_parameters``."""

from linkwright.launch.ros import evaluate_parameter_dict, evaluate_parameters

__all__ = ["evaluate_parameter_dict", "evaluate_parameters"]
