"""Stands in for ``launch_ros.actions.ros_timer``."""

from linkwright.launch.ros import RosTimer
from linkwright.launch.ros import RosTimer as ROSTimer
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ROSTimer", "RosTimer"]
