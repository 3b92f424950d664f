"""Stands in for ``launch_ros.actions.set_use_sim_time``."""

from linkwright.launch.ros import SetUseSimTime

__all__ = ["SetUseSimTime"]
