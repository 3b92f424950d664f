"""Read the remappings that a C++ source passes to its node by ``rclcpp::NodeOptions::arguments``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import pairwise

from linkwright.review.sources.cpp_handles import add_namespace

_ARGUMENTS = re.compile(r"(?:\.|->)\s*arguments\s*\(\s*(?:std\s*::\s*vector\s*<[^<>;]*>\s*)?\{(?P<items>[^{};]*)\}")
_ITEM = re.compile(r'"(?P<text>[^"\\]*)"')
_RULE = re.compile(r"(?P<old>[~/\w]+):=(?P<new>[~/\w]+)")
_NAMESPACE = "__ns"
_NODE_NAMES = ("__node", "__name")
_REMAP_OPTIONS = ("-r", "--remap")


@dataclass(frozen=True)
class Remappings:
    """The remappings of the only node of a source.

    Attributes:
        names: the new names, by old name without a leading slash.
        namespace: the namespace of the node; empty if the arguments set none.
        node: the name of the node; empty if the arguments set none.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    namespace: str = ""
    node: str = ""

    def resolve(self, name: str) -> str:
        """Return the name that a topic, service or action has in the graph."""
        return add_namespace(self.namespace, self.names.get(name.lstrip("/"), name))


def read_remappings(text: str) -> Remappings:
    """Return the remappings in a C++ source; empty if it has arguments for several nodes.

    Args:
        text: the source without comments.
    """
    matches = list(_ARGUMENTS.finditer(text))
    if len(matches) != 1:
        return Remappings()
    items = [item["text"] for item in _ITEM.finditer(matches[0]["items"])]
    rules: dict[str, str] = {}
    for option, item in pairwise(items):
        rule = _RULE.fullmatch(item) if option in _REMAP_OPTIONS else None
        if rule is not None:
            rules[rule["old"].lstrip("/")] = rule["new"]
    node = next((rules[name] for name in _NODE_NAMES if name in rules), "")
    names = {old: new for old, new in rules.items() if not old.startswith("__")}
    return Remappings(names, rules.get(_NAMESPACE, "").rstrip("/"), node)
