"""The nodes and endpoints of other processes, as discovered by a transport."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.names.rules import NodeIdentity


class RemoteEntities(ABC):
    """The discovered nodes and endpoints of other processes.

    One thread writes to this object; any thread may read from it.
    """

    def __init__(self) -> None:
        self._watchers: list[Callable[[], None]] = []
        self.changed_at = time.monotonic()
        """The time of the last change, in seconds of the steady clock."""

    @abstractmethod
    def nodes(self) -> list[NodeIdentity]:
        """Return the nodes of other processes."""

    @abstractmethod
    def endpoints(self) -> list[EndpointInfo]:
        """Return the endpoints of other processes."""

    def watch(self, callback: Callable[[], None]) -> None:
        """Register a callback for changes.

        The callback runs in the discovery thread.
        """
        self._watchers.append(callback)

    def announce(self) -> None:
        """Call the registered callbacks after a change."""
        self.changed_at = time.monotonic()
        for watcher in tuple(self._watchers):
            watcher()
