"""Stands in for ``launch_ros.descriptions``."""

from linkwright.launch.ros import ComposableLifecycleNode, ComposableNode, Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]
