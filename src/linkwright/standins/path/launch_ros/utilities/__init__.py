"""Stands in for ``launch_ros.utilities``.

Functions are taken from the submodules, some of which bear their names: what is imported last stays.
"""

from launch_ros.utilities.evaluate_parameters import evaluate_parameter_dict, evaluate_parameters
from launch_ros.utilities.lifecycle_event_manager import LifecycleEventManager
from launch_ros.utilities.namespace_utils import (
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    prefix_namespace,
)
from launch_ros.utilities.normalize_parameters import normalize_parameter_dict, normalize_parameters
from launch_ros.utilities.normalize_remap_rule import normalize_remap_rule, normalize_remap_rules
from launch_ros.utilities.to_parameters_list import to_parameters_list
from launch_ros.utilities.track_node_names import add_node_name, get_node_name_count
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "LifecycleEventManager",
    "add_node_name",
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "get_node_name_count",
    "is_namespace_absolute",
    "is_root_namespace",
    "make_namespace_absolute",
    "normalize_parameter_dict",
    "normalize_parameters",
    "normalize_remap_rule",
    "normalize_remap_rules",
    "prefix_namespace",
    "to_parameters_list",
]

__getattr__ = submodules_of(__name__)
