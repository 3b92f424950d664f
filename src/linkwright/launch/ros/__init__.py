"""The actions, substitutions and parameter descriptions of ``launch_ros``."""

from linkwright.launch.ros.node import Node
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_values import Parameter, ParameterValue
from linkwright.launch.ros.scoping import PushRosNamespace, SetParameter, SetParametersFromFile, SetRemap
from linkwright.launch.ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare

__all__ = [
    "ExecutableInPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Node",
    "Parameter",
    "ParameterFile",
    "ParameterValue",
    "PushRosNamespace",
    "SetParameter",
    "SetParametersFromFile",
    "SetRemap",
]
