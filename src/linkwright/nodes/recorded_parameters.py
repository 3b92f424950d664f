"""The recorded parameters of nodes and of their plugins.

``node_parameters.json`` has their types and defaults, which ``tools/node_parameters.py`` records.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

_FILE = "node_parameters.json"


@cache
def load_table() -> Mapping[str, Any]:
    """Return the parameters of ``nodes`` by the name of the node, and the ``plugins`` by their class."""
    text = resources.files("linkwright.nodes").joinpath(_FILE).read_text(encoding="utf-8")
    table: Mapping[str, Any] = json.loads(text)
    return table


def find_recorded_type(node: str, parameter: str) -> str:
    """Return the ROS 2 type of a parameter of a node, such as ``string_array``, or empty if it is unknown.

    Args:
        node: the name of the node, without a namespace.
        parameter: the name of the parameter.
    """
    return _get_type(load_table()["nodes"].get(node, {}), parameter)


def find_recorded_plugin_type(plugin: str, parameter: str) -> str:
    """Return the ROS 2 type of a parameter of a plugin, or empty if it is unknown.

    Args:
        plugin: the class of the plugin, with ``::`` or ``/`` after its package.
        parameter: the name of the parameter, without that of the plugin.
    """
    plugins = load_table()["plugins"]
    entry = plugins.get(plugin.replace("::", "/")) or plugins.get(plugin.replace("/", "::"), {})
    return _get_type(entry.get("parameters", {}), parameter)


def _get_type(table: Mapping[str, Mapping[str, Any]], parameter: str) -> str:
    kind: str = table.get(parameter, {}).get("type", "")
    return kind
