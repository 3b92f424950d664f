"""Stands in for ``launch_ros.substitutions.parameter``."""

from linkwright.launch.ros import ParameterSubstitution as Parameter
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Parameter"]
