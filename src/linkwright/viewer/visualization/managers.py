"""Which page sees which configuration: one that pages share, and one for each page that asks for its own."""

from __future__ import annotations

import asyncio

from linkwright.viewer.config.rviz_config import RvizConfig
from linkwright.viewer.context import ViewerContext
from linkwright.viewer.visualization.manager import ManagerOwner, VisualizationManager
from linkwright.viewer.web.audience import Page

LINGERING = 60.0
"""Seconds that displays of a page's own outlive it: it may be reloading, or have lost its connection."""

MOST_LINGERING = 8
"""When more wait for their page, the one that has waited longest is closed."""


class Managers:
    """The manager that all share, and those of single pages, which begin with a copy of the shared configuration.

    Args:
        context: what all of the viewer works with.
        config: of every page that does not ask for its own.
        owner: told of what happens to them.
    """

    def __init__(self, context: ViewerContext, config: RvizConfig, owner: ManagerOwner) -> None:
        self.shared = VisualizationManager(context, config, owner)
        self._owner = owner
        self._own: dict[str, VisualizationManager] = {}
        self._ends: dict[str, asyncio.TimerHandle] = {}

    def all(self) -> list[VisualizationManager]:
        """Every manager, the shared one first."""
        return [self.shared, *self._own.values()]

    def of(self, page: Page) -> VisualizationManager:
        """What a page sees."""
        return self._own.get(page.own, self.shared)

    def enter(self, page: Page) -> VisualizationManager:
        """The manager for a page that opens; made when the page is the first to ask for it."""
        if page.own:
            end = self._ends.pop(page.own, None)
            if end is not None:
                end.cancel()
            if page.own not in self._own:
                self._own[page.own] = VisualizationManager(self.shared.context, self.shared.config.copy(), self._owner)
                self._own[page.own].start()
        return self.of(page)

    def leave(self, page: Page) -> None:
        """A page closed; a manager without pages is closed after a while."""
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
        self._owner.manager_closed(manager)
