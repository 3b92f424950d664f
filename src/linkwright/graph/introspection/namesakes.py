"""Nodes of other processes that share the name of one of ours, as a second launch of a robot's would."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection

from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity

OnNamesakes = Callable[[frozenset[str]], object]
"""Takes the full names of all nodes of ours whose names are shared now; from any thread, one call after another."""


class Namesakes:
    """Tracks names of our nodes that nodes of other processes share, and reports changes.

    Args:
        notify: receives the changes. When left out, each name is logged once by its node, as long as it is shared.
    """

    def __init__(self, notify: OnNamesakes | None = None) -> None:
        self._notify = notify
        self._shared: frozenset[str] = frozenset()
        self._lock = threading.RLock()

    def review(self, ours: Collection[NodeHandle], outside: Collection[NodeIdentity]) -> None:
        """Compare the names of our nodes with those outside; report when the shared ones have changed."""
        if not outside and not self._shared:
            return
        with self._lock:
            there = {node_identity.full_name for node_identity in outside}
            before = self._shared
            self._shared = frozenset(node.identity.full_name for node in ours) & there
            if self._shared == before:
                return
            if self._notify is not None:
                self._notify(self._shared)
                return
            for node in ours:
                name = node.identity.full_name
                if name in self._shared and name not in before:
                    node.logger.warning(
                        f"Another process has a node of the exact name '{name}' too: this can have unintended side "
                        "effects. If it belongs to another robot or program, give one of them another ROS_DOMAIN_ID"
                    )
