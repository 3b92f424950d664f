"""Stands in for ``launch_ros.actions``."""

from linkwright.launch.ros import Node, PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap
from linkwright.launch.ros import PushRosNamespace as PushROSNamespace

__all__ = ["Node", "PushROSNamespace", "PushRosNamespace", "SetParameter", "SetParametersFromFile", "SetRemap"]
