"""Stands in for ``launch_ros.actions.set_ros_log_dir``."""

from linkwright.launch.ros import SetROSLogDir
from linkwright.launch.ros import SetROSLogDir as SetRosLogDir
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetROSLogDir", "SetRosLogDir"]
