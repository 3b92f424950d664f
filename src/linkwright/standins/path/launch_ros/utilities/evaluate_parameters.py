"""Stands in for ``launch_ros.utilities.evaluate_parameters``."""

from linkwright.launch.ros import evaluate_parameter_dict, evaluate_parameters
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["evaluate_parameter_dict", "evaluate_parameters"]
