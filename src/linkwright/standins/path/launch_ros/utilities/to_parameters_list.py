"""Stands in for ``launch_ros.utilities.to_parameters_list``."""

from linkwright.launch.ros import to_parameters_list
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["to_parameters_list"]
