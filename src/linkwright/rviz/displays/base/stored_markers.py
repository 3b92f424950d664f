"""A base class for displays that draw markers and send only changes to pages."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import phrase
from linkwright.page.files import MeshIndex
from linkwright.page.outbox import Payload
from linkwright.page.protocol.robot import MeshStatus
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.displays.base.display import DisplayHost
from linkwright.rviz.displays.base.topic_display import TopicDisplay
from linkwright.rviz.markers import MarkerStore


class StoredMarkersDisplay(TopicDisplay):
    """A base class for displays with a `MarkerStore`.

    A subclass changes the store, and then calls `show_markers`.
    """

    TRANSFORMED = False

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._store = MarkerStore(identity)
        self._meshes = MeshIndex(host.context.finder)

    def stop(self) -> None:
        """Unsubscribe, and stop serving the markers' meshes and textures to pages."""
        super().stop()
        self.context.meshes.replace(self.id, {})

    def data(self) -> list[Payload]:
        """Return the store, from which all current markers are packed."""
        return [self._store]

    def receive(self, message: Any) -> None:
        """Show an error in the status if a page cannot load a mesh or texture of a marker."""
        if isinstance(message, MeshStatus) and message.error is not None and message.link in self._store:
            self.set_status_row(
                message.link,
                "error",
                phrase("Mesh resource marker [{link}]: {error}", link=message.link, error=message.error[:500]),
            )

    def show_markers(self) -> None:
        """Send all changes to the store to the pages, with access to the files of the markers."""
        self.context.meshes.replace(self.id, self._meshes.folders)
        self.pages.send_data(self._store.key, self._store)
