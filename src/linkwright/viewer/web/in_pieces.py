"""All of a content of which a page has only a part, sent piece by piece."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.viewer.protocol.pieces import pack_piece

if TYPE_CHECKING:
    from linkwright.viewer.web.scaled_data import ScaledData


class InPieces:
    """Gives a piece each time its turn comes in an outbox, so that whatever else waits goes between them.

    Args:
        payload: the content.
        number: unlike that of those before it.
        size: says how many bytes the next piece may have.
    """

    def __init__(self, payload: ScaledData, number: int, size: Callable[[], int]) -> None:
        self.payload = payload
        self.key = payload.key
        self._number = number
        self._size = size
        self._given = 0

    @property
    def done(self) -> bool:
        """Whether all of it was given, or it is not wanted any more."""
        return self.payload.gone or self._given >= len(self.payload.whole)

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """The next piece; None when there is none. What the page has seen does not matter: it is counted here."""
        if self.done:
            return None, seen
        size = self._size()
        piece = pack_piece(self.payload.whole, self._number, self._given, size)
        self._given += size
        return piece, seen
