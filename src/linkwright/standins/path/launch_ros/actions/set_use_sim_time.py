"""Stands in for ``launch_ros.actions.set_use_sim_time``."""

from linkwright.launch.ros import SetUseSimTime
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetUseSimTime"]
