"""Stands in for ``launch_ros.utilities.normalize_parameters``."""

from linkwright.launch.ros import normalize_parameter_dict, normalize_parameters
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["normalize_parameter_dict", "normalize_parameters"]
