"""Stands in for ``launch_ros.actions.set_remap``."""

from linkwright.launch.ros import SetRemap

__all__ = ["SetRemap"]
