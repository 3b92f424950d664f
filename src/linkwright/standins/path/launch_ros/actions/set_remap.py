"""Stands in for ``launch_ros.actions.set_remap``."""

from linkwright.launch.ros import SetRemap
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetRemap"]
