"""Stands in for ``launch_ros.actions.ros_timer``."""

from linkwright.launch.ros import RosTimer
from linkwright.launch.ros import RosTimer as ROSTimer

__all__ = ["ROSTimer", "RosTimer"]
