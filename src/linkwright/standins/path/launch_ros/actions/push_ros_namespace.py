"""Stands in for ``launch_ros.actions.push_ros_namespace``."""

from linkwright.launch.ros import PushRosNamespace

__all__ = ["PushRosNamespace"]
