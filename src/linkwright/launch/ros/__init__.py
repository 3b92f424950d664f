"""The actions, substitutions and parameter descriptions of ``launch_ros``."""

from linkwright.launch.ros.components import (
    ComposableLifecycleNode,
    ComposableNode,
    get_composable_node_load_request,
    to_parameters_list,
)
from linkwright.launch.ros.containers import ComposableNodeContainer, LoadComposableNodes
from linkwright.launch.ros.executables import Executable, builtin_packages, find_executable, find_executables
from linkwright.launch.ros.lifecycle import LifecycleEventManager, LifecycleNode
from linkwright.launch.ros.lifecycle_events import (
    ChangeState,
    OnStateTransition,
    StateTransition,
    matches_node_name,
)
from linkwright.launch.ros.lifecycle_transition import LifecycleTransition
from linkwright.launch.ros.names import (
    add_node_name,
    get_node_name_count,
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    normalize_remap_rule,
    normalize_remap_rules,
    prefix_namespace,
)
from linkwright.launch.ros.node import Node
from linkwright.launch.ros.node_extensions import NodeActionExtension
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_lists import (
    evaluate_parameter_dict,
    evaluate_parameters,
    normalize_parameter_dict,
    normalize_parameters,
)
from linkwright.launch.ros.parameter_values import Parameter, ParameterValue
from linkwright.launch.ros.scoping import (
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from linkwright.launch.ros.substitutions import (
    ExecutableInPackage,
    FindPackage,
    FindPackagePrefix,
    FindPackageShare,
    ParameterSubstitution,
)
from linkwright.launch.ros.timer import RosTimer

__all__ = [
    "ChangeState",
    "ComposableLifecycleNode",
    "ComposableNode",
    "ComposableNodeContainer",
    "Executable",
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "LifecycleEventManager",
    "LifecycleNode",
    "LifecycleTransition",
    "LoadComposableNodes",
    "Node",
    "NodeActionExtension",
    "OnStateTransition",
    "Parameter",
    "ParameterFile",
    "ParameterSubstitution",
    "ParameterValue",
    "PushRosNamespace",
    "RosTimer",
    "SetParameter",
    "SetParametersFromFile",
    "SetROSLogDir",
    "SetRemap",
    "SetUseSimTime",
    "StateTransition",
    "add_node_name",
    "builtin_packages",
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "find_executable",
    "find_executables",
    "get_composable_node_load_request",
    "get_node_name_count",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "matches_node_name",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
    "to_parameters_list",
]
