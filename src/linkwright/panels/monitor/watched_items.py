"""Features of panels with a list of names, of which each page watches one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature


class WatchedItem(Protocol):
    """The clients and subscriptions for one name of the list."""

    def close(self) -> None:
        """Close all clients and subscriptions."""


Item = TypeVar("Item", bound=WatchedItem)


@dataclass(slots=True)
class _Request:
    wants_list: bool
    name: str | None
    sent: ServerMessage | None = None


class WatchedItemsFeature(PageFeature, ABC, Generic[Item]):
    """The base class of features that send a list of names, and follow the names that pages watch."""

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._requests: dict[Page, _Request] = {}
        self._items: dict[str, Item] = {}

    @abstractmethod
    def create_item(self, name: str) -> Item:
        """Start to follow a name."""

    @abstractmethod
    def make_list(self) -> ServerMessage:
        """Return the list of names."""

    def remove_page(self, page: Page) -> None:
        """Discard the page's requests, and close what no other page needs."""
        if self._requests.pop(page, None) is not None:
            self._update()

    def close(self) -> None:
        """Close all items."""
        self._requests.clear()
        self._update()

    def watch(self, page: Page, name: str | None, *, wants_list: bool) -> Item | None:
        """Replace what a page watches, and return the item under the name."""
        self._requests[page] = _Request(wants_list, name)
        if name is not None and name not in self._items:
            self._items[name] = self.create_item(name)
        self._update()
        self._send_lists()
        return None if name is None else self._items[name]

    def find_watched(self, page: Page, name: str) -> Item | None:
        """Return the item under a name, or None if the page does not watch this name."""
        request = self._requests.get(page)
        return self._items[name] if request is not None and request.name == name else None

    def publish(self, name: str, message: ServerMessage) -> None:
        """Send a message to the pages that watch a name."""
        for page, request in self._requests.items():
            if request.name == name:
                page.send(message)

    def _update(self) -> None:
        requests = self._requests.values()
        for name in self._items.keys() - {request.name for request in requests}:
            self._items.pop(name).close()
        if any(request.wants_list for request in requests):
            self.context.graph_changes.watch(self._send_lists)
        else:
            self.context.graph_changes.unwatch(self._send_lists)

    def _send_lists(self) -> None:
        names = self.make_list()
        for page, request in self._requests.items():
            if request.wants_list and request.sent != names:
                request.sent = names
                page.send(names)
