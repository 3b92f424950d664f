"""Stands in for ``launch_ros.descriptions``."""

from linkwright.launch.ros import ComposableLifecycleNode, ComposableNode, Parameter, ParameterFile, ParameterValue
from linkwright.standins.imported_names import submodules_of

__all__ = ["ComposableLifecycleNode", "ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]

__getattr__ = submodules_of(__name__)
