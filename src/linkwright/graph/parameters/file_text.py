"""Parameters of a node as the text of a parameter file, as ``ros2 param dump`` writes it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def parameter_file_text(node: str, values: Mapping[str, Any]) -> str:
    """The file, in YAML.

    Args:
        node: the node's full name.
        values: by the parameters' names, as plain Python data; see `plain_value`.
    """
    import yaml

    tree: dict[str, Any] = {}
    for name, value in values.items():
        _insert(tree, name.split("."), value)
    return yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False, allow_unicode=True)


def plain_value(value: Any) -> Any:
    """A rcl_interfaces/msg/ParameterValue as plain Python data; arrays as lists, None when it is not set."""
    from linkwright.graph.parameters.parameter import parameter_value_to_python

    found = parameter_value_to_python(value)
    return found if found is None or isinstance(found, (bool, int, float, str)) else list(found)


def _insert(tree: dict[str, Any], path: list[str], value: Any) -> None:
    """Put a value below the parts of its name; where a part has a value itself the name stays whole."""
    for at, part in enumerate(path[:-1]):
        below = tree.setdefault(part, {})
        if not isinstance(below, dict):
            tree[".".join(path[at:])] = value
            return
        tree = below
    tree[path[-1]] = value
