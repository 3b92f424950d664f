"""The graph outside of this process, as a transport's discovery finds it."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable

from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.names.rules import NodeIdentity


class Outside(ABC):
    """The nodes and endpoints that discovery found; written by one thread, read by any."""

    def __init__(self) -> None:
        self._watchers: list[Callable[[], None]] = []
        self.changed_at = time.monotonic()
        """The time of the last change, by the steady clock."""

    @abstractmethod
    def nodes(self) -> list[NodeIdentity]:
        """The nodes of other processes."""

    @abstractmethod
    def endpoints(self) -> list[EndpointInfo]:
        """The endpoints of other processes."""

    def watch(self, changed: Callable[[], None]) -> None:
        """Register a callback for changes, called in the thread of discovery."""
        self._watchers.append(changed)

    def announce(self) -> None:
        """Notify the watchers that something has changed."""
        self.changed_at = time.monotonic()
        for watcher in tuple(self._watchers):
            watcher()
