"""The recorded topics, services and actions of nodes.

``node_topics.json`` has their names, types and roles, which ``tools/node_topics.py`` records.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

_FILE = "node_topics.json"


@cache
def load_table() -> Mapping[str, Any]:
    """Return the default name (``node``) and the ``topics`` of programs, by package and executable."""
    text = resources.files("linkwright.nodes").joinpath(_FILE).read_text(encoding="utf-8")
    table: Mapping[str, Any] = json.loads(text)
    return table


def find_recorded_roles(program: str, name: str) -> frozenset[str]:
    """Return the roles of a program for a name, such as ``publisher`` or ``action client``; empty if unknown.

    Args:
        program: the package and the executable.
        name: the name of a topic, service or action in the program, without a leading ``/`` or ``~/``.
    """
    topics = load_table().get(program, {}).get("topics", ())
    return frozenset(role for own_name, _, role in topics if own_name.lstrip("~/") == name)
