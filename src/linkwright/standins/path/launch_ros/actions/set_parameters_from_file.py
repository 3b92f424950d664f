"""Stands in for ``launch_ros.actions.set_parameters_from_file``."""

from linkwright.launch.ros import SetParametersFromFile
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetParametersFromFile"]
