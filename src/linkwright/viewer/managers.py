"""Who sees which configuration: one for all pages, and one of its own for each page that asks for that."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Mapping

from linkwright.viewer.audience import Page
from linkwright.viewer.manager import VisualizationManager

LINGERING = 60.0
"""Seconds that displays of a page's own wait for it: it may be loading anew, or have lost its connection."""

MOST_LINGERING = 8
"""Of more that wait for their page the one that has waited longest ends."""

_KEY = re.compile(r"[0-9A-Za-z-]{8,64}")


def own_displays(query: Mapping[str, str]) -> str:
    """By what a page names displays of its own in the address of its socket; empty for one that shares those of all."""
    key = query.get("own", "")
    return key if _KEY.fullmatch(key) else ""


class Managers:
    """The manager that all share, and those of single pages.

    Args:
        shared: of every page that does not ask for its own.
        make: a new one with a copy of the shared configuration, started.
        dropped: told of one that has ended.
    """

    def __init__(
        self,
        shared: VisualizationManager,
        make: Callable[[], VisualizationManager],
        dropped: Callable[[VisualizationManager], None],
    ) -> None:
        self.shared = shared
        self._make = make
        self._dropped = dropped
        self._own: dict[str, VisualizationManager] = {}
        self._ends: dict[str, asyncio.TimerHandle] = {}

    def all(self) -> list[VisualizationManager]:
        """Every manager, the shared one first."""
        return [self.shared, *self._own.values()]

    def of(self, page: Page) -> VisualizationManager:
        """What a page sees."""
        return self._own.get(page.own, self.shared)

    def enter(self, page: Page) -> VisualizationManager:
        """What a page is going to see; it is made when the page is the first to name it."""
        if page.own:
            end = self._ends.pop(page.own, None)
            if end is not None:
                end.cancel()
            if page.own not in self._own:
                self._own[page.own] = self._make()
        return self.of(page)

    def leave(self, page: Page) -> None:
        """Have a page see nothing more; a manager that nobody sees ends after a while."""
        manager = self.of(page)
        manager.pages.discard(page)
        if manager is not self.shared and not len(manager.pages):
            self._ends[page.own] = asyncio.get_running_loop().call_later(LINGERING, self._drop, page.own)
            if len(self._ends) > MOST_LINGERING:
                self._drop(next(iter(self._ends)))

    def close(self) -> None:
        """End all of them."""
        for key in list(self._own):
            self._drop(key)
        self.shared.close()

    def _drop(self, key: str) -> None:
        end = self._ends.pop(key, None)
        if end is not None:
            end.cancel()
        manager = self._own.pop(key)
        manager.close()
        self._dropped(manager)
