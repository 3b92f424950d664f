"""Stands in for ``launch_ros.actions.set_parameter``."""

from linkwright.launch.ros import SetParameter
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetParameter"]
