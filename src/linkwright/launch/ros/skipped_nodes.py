"""Removal of skipped nodes from the node lists of nav2's lifecycle managers.

A lifecycle manager would wait forever for a skipped node.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.model.context import LaunchContext

_MANAGER_PACKAGE = "nav2_lifecycle_manager"
_NODES_PARAMETER = "node_names"


def record_skipped_node(context: LaunchContext, name: str) -> None:
    """Record the name, without the namespace, of a node that is skipped."""
    context.session.skipped_nodes.add(name)


def without_skipped_nodes(context: LaunchContext, package: str, parameters: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters of a node, in which a lifecycle manager has no skipped nodes.

    A warning is logged for each removed node.
    """
    if package != _MANAGER_PACKAGE or not isinstance(parameters.get(_NODES_PARAMETER), Iterable):
        return parameters
    return {**parameters, _NODES_PARAMETER: _without_skipped(context, parameters[_NODES_PARAMETER])}


def remove_skipped_nodes(context: LaunchContext, request: Any) -> None:
    """Remove the skipped nodes from a request that loads a lifecycle manager into a container.

    Other requests remain unchanged.
    """
    if request.package_name != _MANAGER_PACKAGE:
        return
    for parameter in request.parameters:
        if parameter.name == _NODES_PARAMETER:
            parameter.value.string_array_value = _without_skipped(context, parameter.value.string_array_value)


def _without_skipped(context: LaunchContext, names: Iterable[str]) -> list[str]:
    remaining_names = []
    for name in names:
        if name.rpartition("/")[2] in context.session.skipped_nodes:
            context.session.log.write_warning("launch", f"'{name}' is skipped, so no lifecycle manager waits for it")
        else:
            remaining_names.append(name)
    return remaining_names
