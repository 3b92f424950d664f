"""Stands in for ``launch_ros.utilities.to_parameters_list``."""

from linkwright.launch.ros import to_parameters_list

__all__ = ["to_parameters_list"]
