"""Stands in for ``launch_ros.actions.set_parameters_from_file``."""

from linkwright.launch.ros import SetParametersFromFile

__all__ = ["SetParametersFromFile"]
