"""Stands in for ``launch_ros.utilities``."""

from linkwright.launch.ros import (
    LifecycleEventManager,
    add_node_name,
    evaluate_parameter_dict,
    evaluate_parameters,
    get_node_name_count,
    is_namespace_absolute,
    is_root_namespace,
    make_namespace_absolute,
    normalize_parameter_dict,
    normalize_parameters,
    normalize_remap_rule,
    normalize_remap_rules,
    prefix_namespace,
    to_parameters_list,
)
from linkwright.standins.launch_names import submodules_of

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
