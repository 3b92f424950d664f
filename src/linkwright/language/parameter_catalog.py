"""The parameters of nodes, plugins of nodes, and controllers, with types and defaults.

The parameters of nodes and plugins come from ``linkwright.nodes.recorded_names``. The parameters of controllers
come from the tables that the controllers declare, including controllers of other packages.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from inspect import cleandoc
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.loading.extensions import extensions
from linkwright.nodes.recorded_names import load_parameters

CONTROLLER_MANAGER = "controller_manager"
_CONTROLLERS = "linkwright.controllers"


@dataclass(frozen=True, slots=True)
class ParameterInfo:
    """A parameter.

    Attributes:
        name: the name with dots. A ``*`` matches any name, as in ``gains.*.p``.
        type: the ROS 2 type, such as ``double`` or ``string_array``, or empty if it is unknown.
        default: the default value, or None.
        description: the purpose with its unit, or empty.
        choices: the allowed values, or empty if any value of the type is allowed.
        keys: the parameters that contain the names for ``*``.
        owner: the node, plugin or controller that has the parameter.
    """

    name: str
    type: str
    default: Any = None
    description: str = ""
    choices: tuple[str, ...] = ()
    keys: tuple[str, ...] = ()
    owner: str = ""

    def with_prefix(self, prefix: str, owner: str) -> ParameterInfo:
        """Return the parameter with a prefix before its name."""
        keys = tuple(f"{prefix}.{key}" for key in self.keys)
        return replace(self, name=f"{prefix}.{self.name}", owner=owner, keys=keys)

    def matches(self, name: str) -> bool:
        """Return whether a full name matches the name of the parameter."""
        own_parts, parts = self.name.split("."), name.split(".")
        return len(own_parts) == len(parts) and all(
            mark in ("*", part) for mark, part in zip(own_parts, parts, strict=True)
        )

    def relative_name(self, name: str) -> str:
        """Return the parameter's name relative to a group, or empty if it is not in the group."""
        own_parts, group = self.name.split("."), name.split(".")
        is_inside = len(own_parts) > len(group) and all(
            mark in ("*", part) for mark, part in zip(own_parts, group, strict=False)
        )
        return ".".join(own_parts[len(group) :]) if is_inside else ""

    @property
    def default_text(self) -> str:
        """The default in YAML, or empty if there is none."""
        return "" if self.default is None else to_yaml(self.default)


@dataclass(frozen=True, slots=True)
class Plugin:
    """A plugin type that a node loads.

    Attributes:
        type: the type, such as ``nav2_costmap_2d::InflationLayer``.
        node: the node that loads it.
        list_parameter: the parameter of the node that names its plugins.
        purpose: the purpose of the plugin.
        parameters: the parameters, without the name of the plugin.
    """

    type: str
    node: str
    list_parameter: str
    purpose: str
    parameters: tuple[ParameterInfo, ...]


def to_yaml(value: Any) -> str:
    """Return the value of a parameter in YAML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        text = repr(value)
        return {"nan": ".nan", "inf": ".inf", "-inf": "-.inf"}.get(text, text)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(to_yaml, value))}]"
    text = str(value)
    return text if text and text.strip("[]{}") == text else f'"{text}"'


def _parse_infos(table: Mapping[str, Mapping[str, Any]], owner: str) -> tuple[ParameterInfo, ...]:
    return tuple(
        ParameterInfo(
            name,
            entry.get("type", ""),
            entry.get("default"),
            entry.get("description", ""),
            tuple(entry.get("choices", ())),
            tuple(entry.get("keys", ())),
            owner,
        )
        for name, entry in table.items()
    )


@cache
def node_names() -> tuple[str, ...]:
    """Return the names of the nodes with known parameters."""
    return tuple(load_parameters()["nodes"])


@lru_cache(maxsize=64)
def node_parameters(node: str) -> tuple[ParameterInfo, ...]:
    """Return the parameters of a node by its name, or an empty tuple if it is unknown."""
    return _parse_infos(load_parameters()["nodes"].get(node, {}), node)


@cache
def plugins() -> Mapping[str, Plugin]:
    """Return the plugins by type, with ``/`` in place of ``::``."""
    return {
        kind.replace("::", "/"): Plugin(
            kind, entry["node"], entry["listed"], entry["purpose"], _parse_infos(entry["parameters"], kind)
        )
        for kind, entry in load_parameters()["plugins"].items()
    }


def plugin_types(node: str, list_parameter: str = "") -> list[str]:
    """Return the plugin types that a node loads.

    Args:
        node: the name of the node. A costmap has the same layers under any name.
        list_parameter: the parameter that lists the plugins, or empty for all parameters.
    """
    owner = "local_costmap" if node.endswith("costmap") else node
    return [
        plugin.type
        for plugin in plugins().values()
        if plugin.node == owner and list_parameter in ("", plugin.list_parameter)
    ]


def controller_types() -> list[str]:
    """Return the type names of controllers."""
    return [*extensions(_CONTROLLERS)]


def load_tables() -> None:
    """Read the tables of nodes and plugins, and import the controllers. The first call is slow."""
    plugins()
    for kind in controller_types():
        controller_parameters(kind)


def controller_parameters(kind: str, names: Collection[str] = ()) -> tuple[ParameterInfo, ...]:
    """Return the parameters of a controller type, or an empty tuple if it is unavailable.

    Args:
        kind: the type name.
        names: the names of the parameters that are set, which distinguish controllers with the same type name.
    """
    controller = _find_controller(kind)
    if controller is None:
        return ()
    return _list_controller_parameters(controller.variant(names), kind)


@cache
def _list_controller_parameters(controller: Any, kind: str) -> tuple[ParameterInfo, ...]:
    from linkwright.nodes.parameter_tables import list_entries  # imported here because it loads the graph

    return tuple(
        ParameterInfo(
            entry.name,
            entry.kind.name.lower(),
            entry.default,
            entry.description,
            entry.choices,
            entry.keys,
            kind,
        )
        for entry in list_entries(controller.PARAMETERS)
    )


def controller_purpose(kind: str) -> str | None:
    """Return the first paragraph about a controller type, or None if it is unavailable."""
    controller = _find_controller(kind)
    return None if controller is None else cleandoc(controller.__doc__ or "").partition("\n\n")[0]


def _find_controller(kind: str) -> Any:
    if kind not in extensions(_CONTROLLERS):
        return None
    from linkwright.control.controllers.registry import controller_class

    try:
        return controller_class(kind)
    except LinkwrightError:
        return None


def find_owners(keys: Iterable[str]) -> list[str]:
    """Return the nodes that have any of some parameters, the best match first."""
    names = set(keys)
    counts = {node: sum(parameter.name in names for parameter in node_parameters(node)) for node in node_names()}
    return sorted((node for node, count in counts.items() if count), key=lambda node: -counts[node])
