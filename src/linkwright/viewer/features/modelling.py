"""Modelling a world in the page: its file is edited in place, and the simulation loads what came of it."""

from __future__ import annotations

from linkwright.viewer.features.page_feature import PageFeature
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.protocol.modelling import ModellingState


class ModellingFeature(PageFeature):
    """Tells pages what stands in the world, and edits it as they ask."""

    def opening(self) -> list[ServerMessage]:
        """What stands in the world."""
        return [ModellingState(False, False, None, False, False, False, [])]
