"""Nodes that a launch skips, and nav2's lifecycle manager, which would wait for them forever."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.launch.model.context import LaunchContext

_MANAGER = "nav2_lifecycle_manager"
_MANAGED = "node_names"


def leave_out(context: LaunchContext, name: str) -> None:
    """Record a skipped node, by its name without its namespace."""
    context.session.left_out.add(name)


def without_left_out(context: LaunchContext, package: str, parameters: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters of a node; those of a lifecycle manager omit the nodes that were skipped before it."""
    if package != _MANAGER or not isinstance(parameters.get(_MANAGED), Iterable):
        return parameters
    return {**parameters, _MANAGED: _present(context, parameters[_MANAGED])}


def drop_left_out(context: LaunchContext, request: Any) -> None:
    """Omit skipped nodes as `without_left_out` does, in the request to load a component."""
    if request.package_name != _MANAGER:
        return
    for parameter in request.parameters:
        if parameter.name == _MANAGED:
            parameter.value.string_array_value = _present(context, parameter.value.string_array_value)


def _present(context: LaunchContext, names: Iterable[str]) -> list[str]:
    kept = []
    for name in names:
        if name.rpartition("/")[2] in context.session.left_out:
            context.session.log.warning_line("launch", f"'{name}' is left out, and no lifecycle manager waits for it")
        else:
            kept.append(name)
    return kept
