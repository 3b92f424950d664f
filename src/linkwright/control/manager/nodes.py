"""Create controllers' nodes, with their names, parameters and remappings.

Source: the controller manager of ros2_control. A controller's node gets its parameters from the files in the arguments
of the manager's process, then from the files in ``NAME.params_file``, then from ``NAME.node_options_args``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from linkwright.graph import Node
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.graph.parameters.parameter import ParameterRules

_PROCESS_REMAPPINGS = ("__node", "__name", "__ns")


@dataclass(slots=True)
class ProcessArguments:
    """The arguments of a process or plugin that apply to all nodes of its manager.

    Attributes:
        parameters: the parameters by node name.
        remappings: the rules as pairs ``(from, to)``.
    """

    parameters: ParameterRules = field(default_factory=ParameterRules)
    remappings: Sequence[tuple[str, str]] = ()


def create_controller_node(manager: Node, name: str, process: ProcessArguments) -> Node:
    """Create the node of a controller.

    Raises:
        LinkwrightError: the node's name, or one of its files or arguments, is not valid.
    """
    namespace = manager.get_namespace()
    full_name = join(namespace, name)
    values: dict[str, Any] = {}
    if manager.has_parameter("use_sim_time"):
        values["use_sim_time"] = manager.get_parameter("use_sim_time").value
    values |= process.parameters.for_node(full_name)
    ignored_findings = process.parameters.skipped_findings_for(full_name)
    for path in read_string_list(manager, f"{name}.params_file"):
        rules = read_parameter_file(path)
        values |= rules.for_node(full_name)
        ignored_findings += rules.skipped_findings_for(full_name)
    for message in dict.fromkeys(str(finding.message) for finding in ignored_findings):
        manager.get_logger().warning(f"{name}: {message}; the parameter is left out")
    ros_arguments = parse(
        [
            "--ros-args",
            *(
                argument
                for argument in read_string_list(manager, f"{name}.node_options_args")
                if argument != "--ros-args"
            ),
        ]
    )
    values |= ros_arguments.parameters_for(full_name)
    remappings = [*ros_arguments.remappings_for(name), *process.remappings]
    node = Node(
        manager.graph,
        name,
        namespace=namespace,
        parameters=values,
        remappings=[remapping for remapping in remappings if remapping[0] not in _PROCESS_REMAPPINGS],
    )
    manager.graph.creators[node.get_logger().name] = manager.get_logger().name
    return node


def read_string_list(node: Node, name: str) -> list[str]:
    """Return the strings in a parameter that is a string or a list of strings.

    Returns an empty list if the parameter is not set.
    """
    value = node.get_parameter_or(name).value
    if not value:
        return []
    return [value] if isinstance(value, str) else [str(item) for item in value]
