"""The nodes that a launch skips.

These nodes are removed from nav2's lifecycle managers, which would wait for them forever.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.model.context import LaunchContext

_MANAGER = "nav2_lifecycle_manager"
_MANAGED = "node_names"


def record_skipped_node(context: LaunchContext, name: str) -> None:
    """Record a skipped node by its name without the namespace."""
    context.session.left_out.add(name)


def without_skipped_nodes(context: LaunchContext, package: str, parameters: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters of a node, without skipped nodes if it is a lifecycle manager."""
    if package != _MANAGER or not isinstance(parameters.get(_MANAGED), Iterable):
        return parameters
    return {**parameters, _MANAGED: _without_skipped(context, parameters[_MANAGED])}


def remove_skipped_nodes(context: LaunchContext, request: Any) -> None:
    """Remove the skipped nodes from a request to load a lifecycle manager into a container.

    Other requests are unchanged.
    """
    if request.package_name != _MANAGER:
        return
    for parameter in request.parameters:
        if parameter.name == _MANAGED:
            parameter.value.string_array_value = _without_skipped(context, parameter.value.string_array_value)


def _without_skipped(context: LaunchContext, names: Iterable[str]) -> list[str]:
    kept = []
    for name in names:
        if name.rpartition("/")[2] in context.session.left_out:
            context.session.log.warning_line("launch", f"'{name}' is left out, and no lifecycle manager waits for it")
        else:
            kept.append(name)
    return kept
