"""Types and parameters of the plugins of nav2's servers, such as ``FollowPath.plugin``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import Node, ParameterDescriptor, ParameterType


def get_or_declare(node: Node, name: str, default: Any) -> Any:
    """Return the value of a parameter, declaring it first if necessary."""
    if node.has_parameter(name):
        return node.get_parameter(name).value
    return node.declare_parameter(name, default).value


def get_string_list(node: Node, name: str, default: Sequence[str]) -> list[str]:
    """Return the value of a string-array parameter, which may be empty.

    The parameter is declared first if necessary; see `get_or_declare`.
    """
    if not node.has_parameter(name):
        node.declare_parameter(name, list(default), ParameterDescriptor(dynamic_typing=True))
    return [str(text) for text in node.get_parameter(name).value or ()]


def get_plugin_type(node: Node, plugin: str, defaults: Mapping[str, str]) -> str:
    """Return the type of a plugin from ``PLUGIN.plugin``, with ``::`` replaced by ``/``.

    Args:
        node: the node that has the parameter.
        plugin: the name of the plugin.
        defaults: the default types of plugins, by plugin name.

    Raises:
        LinkwrightError: NODE431, the type is not set.
    """
    name = f"{plugin}.plugin"
    type_name = get_or_declare(node, name, defaults.get(plugin, ParameterType.STRING))
    if not type_name:
        raise LinkwrightError(
            Diagnostic(
                "NODE431",
                phrase("'{node}' needs the parameter '{name}'", node=node.get_name(), name=name),
                hint=phrase("set it to the type of the plugin '{plugin}'", plugin=plugin),
            )
        )
    return str(type_name).replace("::", "/")


def declare_unused(node: Node, plugin: str) -> list[str]:
    """Declare the undeclared parameters of a plugin, and return their names without the prefix."""
    names = [
        undeclared_override
        for undeclared_override in node.undeclared_overrides()
        if undeclared_override.startswith(f"{plugin}.")
    ]
    for name in names:
        node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
    return [name.removeprefix(f"{plugin}.") for name in names]
