"""The command ``ros2 param get`` for nodes in the launcher's process.

A command of a launch file blocks the launcher until it has ended. A node in the launcher's process cannot respond to it
in this time, so its parameters are read without a process.
"""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.launch.model.running_launch import NodeHosting

_HIDE_TYPE = "--hide-type"
_IGNORED_OPTIONS = frozenset({"--include-hidden-nodes", "--no-daemon", "--use-sim-time", "-s"})


def read_hosted_parameter(host: NodeHosting, words: Sequence[str]) -> str | None:
    """Return the output of ``ros2 param get`` for a node in the launcher's process.

    Returns:
        The output, or None if the command is another one, or the node is not in the launcher's process.
    """
    if tuple(words[:3]) != ("ros2", "param", "get"):
        return None
    arguments = [word for word in words[3:] if word != _HIDE_TYPE and word not in _IGNORED_OPTIONS]
    if len(arguments) != 2 or any(argument.startswith("-") for argument in arguments):
        return None
    node_name, parameter_name = arguments
    node = host.find_node(f"/{node_name.lstrip('/')}")
    if node is None:
        return None
    from linkwright.graph.parameters.value_text import UNSET_TEXT, format_parameter_value

    if not node.has_parameter(parameter_name):
        return f"{UNSET_TEXT}\n"
    value = node.get_parameter(parameter_name).get_parameter_value()
    return f"{format_parameter_value(value, hide_type=_HIDE_TYPE in words)}\n"
