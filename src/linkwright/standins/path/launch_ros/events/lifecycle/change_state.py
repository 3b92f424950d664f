"""Stands in for ``launch_ros.events.lifecycle.change_state``."""

from linkwright.launch.ros import ChangeState

__all__ = ["ChangeState"]
