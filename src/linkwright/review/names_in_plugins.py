"""Read names in extensions and worlds: topics, services and frames of plugins, and renamed elements."""

from __future__ import annotations

import re

from linkwright.descriptions.comparison import Difference

NAME_TAGS = re.compile(r"topic|namespace|frame(?!_?(rate|skip|count))|remapping|\bservice", re.IGNORECASE)
"""The tags of parameters with names in the graph or in tf."""
_SLASHES = re.compile("//+")
NAMESPACE_TAG = re.compile(r"namespace", re.IGNORECASE)
"""The tags of the namespaces of plugins."""


def extract_used_name(value: str) -> str:
    """Return the name that other programs use.

    For a remapping such as ``~/out:=scan``, it is the right side. Repeated slashes, as in ``/$(arg prefix)/scan`` with
    an empty prefix, count as one.
    """
    return _SLASHES.sub("/", value.rpartition(":=")[2].strip())


def find_old_path(difference: Difference, path: str) -> str | None:
    """Return the path of a renamed element with its old name; None for other differences.

    Args:
        difference: the difference between both versions.
        path: the path of the value that differs.
    """
    element, is_name, _ = path.rpartition("@name")
    element = element.strip()
    if not is_name or not difference.old or not difference.new or not element.endswith(f" {difference.new}"):
        return None
    return element.removesuffix(difference.new) + difference.old
