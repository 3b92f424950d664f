"""Stands in for ``launch_ros.actions.push_ros_namespace``."""

from linkwright.launch.ros import PushRosNamespace
from linkwright.launch.ros import PushRosNamespace as PushROSNamespace
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PushROSNamespace", "PushRosNamespace"]
