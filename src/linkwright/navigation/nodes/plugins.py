"""Types and parameters, ``NAME.parameter``, of the plugins of nav2's servers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Node, ParameterDescriptor, ParameterType


def value_of(node: Node, name: str, default: Any) -> Any:
    """The value of a parameter, which is declared if it is not yet."""
    if node.has_parameter(name):
        return node.get_parameter(name).value
    return node.declare_parameter(name, default).value


def texts_of(node: Node, name: str, default: Sequence[str]) -> list[str]:
    """As `value_of`, for a list of texts, which may be given empty."""
    if not node.has_parameter(name):
        node.declare_parameter(name, list(default), ParameterDescriptor(dynamic_typing=True))
    return [str(text) for text in node.get_parameter(name).value or ()]


def type_of(node: Node, plugin: str, usual: Mapping[str, str]) -> str:
    """The type of a plugin from ``PLUGIN.plugin``, with ``/`` for ``::``.

    Args:
        node: whose it is.
        plugin: its name.
        usual: types by the names that need none.

    Raises:
        LinkwrightError: NODE431, it is not given.
    """
    name = f"{plugin}.plugin"
    given = value_of(node, name, usual.get(plugin, ParameterType.STRING))
    if not given:
        raise LinkwrightError(
            Diagnostic(
                "NODE431",
                phrase("'{node}' needs the parameter '{name}'", node=node.get_name(), name=name),
                hint=phrase("it is the type of the plugin '{plugin}'", plugin=plugin),
            )
        )
    return str(given).replace("::", "/")


def declare_unread(node: Node, plugin: str) -> list[str]:
    """Declare the unknown parameters of a plugin; their names without the plugin's."""
    names = [
        undeclared_override
        for undeclared_override in node.undeclared_overrides()
        if undeclared_override.startswith(f"{plugin}.")
    ]
    for name in names:
        node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
    return [name.removeprefix(f"{plugin}.") for name in names]
