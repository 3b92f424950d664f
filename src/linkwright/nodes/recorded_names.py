"""The recorded parameters of nodes and of their plugins, and the topics, services and actions of nodes.

``node_parameters.json`` and ``node_topics.json`` have them, which ``tools/node_parameters.py`` and
``tools/node_topics.py`` record.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any


def load_parameters() -> Mapping[str, Any]:
    """Return the parameters of ``nodes`` by the name of the node, and the ``plugins`` by their class."""
    return _load("node_parameters.json")


def load_topics() -> Mapping[str, Any]:
    """Return the default name (``node``) and the ``topics`` of programs, by package and executable."""
    return _load("node_topics.json")


@cache
def _load(file: str) -> Mapping[str, Any]:
    text = resources.files("linkwright.nodes").joinpath(file).read_text(encoding="utf-8")
    table: Mapping[str, Any] = json.loads(text)
    return table


def find_recorded_type(node: str, parameter: str) -> str:
    """Return the ROS 2 type of a parameter of a node, such as ``string_array``, or empty if it is unknown.

    Args:
        node: the name of the node, without a namespace.
        parameter: the name of the parameter.
    """
    return _get_type(load_parameters()["nodes"].get(node, {}), parameter)


def find_recorded_plugin_type(plugin: str, parameter: str) -> str:
    """Return the ROS 2 type of a parameter of a plugin, or empty if it is unknown.

    Args:
        plugin: the class of the plugin, with ``::`` or ``/`` after its package.
        parameter: the name of the parameter, without that of the plugin.
    """
    plugins = load_parameters()["plugins"]
    entry = plugins.get(plugin.replace("::", "/")) or plugins.get(plugin.replace("/", "::"), {})
    return _get_type(entry.get("parameters", {}), parameter)


def _get_type(table: Mapping[str, Mapping[str, Any]], parameter: str) -> str:
    kind: str = table.get(parameter, {}).get("type", "")
    return kind


def find_recorded_roles(program: str, name: str) -> frozenset[str]:
    """Return the roles of a program for a name, such as ``publisher`` or ``action client``; empty if unknown.

    Args:
        program: the package and the executable.
        name: the name of a topic, service or action in the program, without a leading ``/`` or ``~/``.
    """
    topics = load_topics().get(program, {}).get("topics", ())
    return frozenset(role for own_name, _, role in topics if own_name.lstrip("~/") == name)
