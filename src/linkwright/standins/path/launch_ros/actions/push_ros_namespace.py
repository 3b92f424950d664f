"""Stands in for ``launch_ros.actions.push_ros_namespace``."""

from linkwright.launch.ros import PushRosNamespace
from linkwright.launch.ros import PushRosNamespace as PushROSNamespace

__all__ = ["PushROSNamespace", "PushRosNamespace"]
