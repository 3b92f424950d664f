"""Warns of nodes of other processes that share the name of one of ours, as a second launch of a robot's would."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING

from linkwright.graph.transport import NodeIdentity

if TYPE_CHECKING:
    from linkwright.graph.node import Node


class Namesakes:
    """Remembers which shared names were told: each once, as long as it is shared."""

    def __init__(self) -> None:
        self._told: set[str] = set()

    def review(self, ours: Iterable[Node], outside: Collection[NodeIdentity]) -> None:
        """Tell of names that have come to be shared."""
        names = {f"{each.namespace.rstrip('/')}/{each.name}" for each in outside} if outside else set()
        self._told &= names
        if not names:
            return
        for node in ours:
            name = node.get_fully_qualified_name()
            if name in names and name not in self._told:
                self._told.add(name)
                node.get_logger().warning(
                    f"Another process has a node of the exact name '{name}' too: this can have unintended side effects"
                )
