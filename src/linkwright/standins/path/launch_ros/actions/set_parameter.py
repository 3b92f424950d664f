"""Stands in for ``launch_ros.actions.set_parameter``."""

from linkwright.launch.ros import SetParameter

__all__ = ["SetParameter"]
