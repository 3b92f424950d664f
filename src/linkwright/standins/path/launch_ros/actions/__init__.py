"""Stands in for ``launch_ros.actions``."""

from linkwright.launch.ros import (
    ComposableNodeContainer,
    LifecycleNode,
    LifecycleTransition,
    LoadComposableNodes,
    Node,
    PushRosNamespace,
    RosTimer,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from linkwright.launch.ros import PushRosNamespace as PushROSNamespace
from linkwright.launch.ros import RosTimer as ROSTimer
from linkwright.launch.ros import SetROSLogDir as SetRosLogDir
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "ComposableNodeContainer",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "PushROSNamespace",
    "PushRosNamespace",
    "ROSTimer",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetRosLogDir",
    "SetUseSimTime",
]

__getattr__ = submodules_of(__name__)
