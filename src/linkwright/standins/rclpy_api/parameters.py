"""Parameter services, and parameters from strings and files (rclpy ``parameter``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.graph.parameters.files import parse_value, read_parameter_file
from linkwright.graph.parameters.node_parameters import ParameterServices
from linkwright.graph.parameters.parameter import ANY_NODE, Parameter

if TYPE_CHECKING:
    from linkwright.standins.rclpy_api.node import Node


class ParameterService(ParameterServices):
    """The services through which other nodes read and set the parameters of a node."""

    def __init__(self, node: Node) -> None:
        super().__init__(node, node.get_name(), node.create_service)


def get_parameter_value(string_value: str) -> Any:
    """Convert a string to the value of a parameter (rcl_interfaces/msg/ParameterValue).

    The string is parsed as YAML. If the result is not a valid parameter value, the string itself is the value.
    """
    if not string_value.strip():
        return Parameter("", value=string_value).get_parameter_value()
    try:
        return Parameter("", value=parse_value(string_value, "")).get_parameter_value()
    except (TypeError, ValueError):
        return Parameter("", value=string_value).get_parameter_value()


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: Sequence[str] | None = None,
    namespace: str = "",
) -> dict[str, Any]:
    """Return the parameters in a file (rcl_interfaces/msg/Parameter) by name.

    Args:
        parameter_file: the path of the parameter file.
        use_wildcard: whether to include the parameters of ``/**``.
        target_nodes: the full names of the nodes to read parameters for; None for all.
        namespace: a prefix of each parameter name, followed by a dot.

    Raises:
        RuntimeError: the file has no parameters for the nodes.
        LinkwrightError: the file cannot be read.
    """
    # The leading slash of a node name is optional, both in `target_nodes` and in the file.
    values_by_node: dict[str, dict[str, Any]] = {}
    for pattern, values in read_parameter_file(parameter_file):
        values_by_node.setdefault(_to_absolute_name(pattern), {}).update(values)
    node_names = (
        list(values_by_node)
        if target_nodes is None
        else [name for name in map(_to_absolute_name, target_nodes) if name in values_by_node]
    )
    if target_nodes is not None and use_wildcard and ANY_NODE in values_by_node:
        node_names.insert(0, ANY_NODE)
    if not use_wildcard:
        node_names = [name for name in node_names if name != ANY_NODE]
    if target_nodes and not node_names:
        raise RuntimeError(f"Param file does not contain any parameters for {', '.join(target_nodes)}")
    parameters: dict[str, Any] = {}
    for pattern in node_names:
        for name, value in values_by_node[pattern].items():
            full_name = f"{namespace}.{name}" if namespace else name
            parameters[full_name] = Parameter(full_name, value=value).to_parameter_msg()
    return parameters


def _to_absolute_name(pattern: str) -> str:
    return "/" + pattern.lstrip("/")
