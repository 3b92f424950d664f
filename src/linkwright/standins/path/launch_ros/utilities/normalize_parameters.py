"""Stands in for ``launch_ros.utilities.normalize_parameters``."""

from linkwright.launch.ros import normalize_parameter_dict, normalize_parameters

__all__ = ["normalize_parameter_dict", "normalize_parameters"]
