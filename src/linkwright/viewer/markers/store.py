"""The markers that a display shows, and the changes that each page has yet to be sent."""

from __future__ import annotations

from linkwright.viewer.protocol.data import pack_data
from linkwright.viewer.protocol.markers import MarkersChanged, MarkerShape

_MOST_GONE = 5000
"""How many markers that went are remembered; a page that missed more of them is sent everything anew."""


class MarkerStore:
    """Markers by id, counted by change, so that a page can be sent what happened since it was sent the last.

    It is the `outbox.Changes` of its display.

    Args:
        display: the id of the display.
    """

    def __init__(self, display: str) -> None:
        self.key = f"data {display}"
        self._display = display
        self._shown: dict[str, tuple[int, MarkerShape]] = {}
        self._gone: dict[str, int] = {}
        self._change = 0
        self._oldest = 0
        self._packed: tuple[int, int, bytes] | None = None

    def __len__(self) -> int:
        return len(self._shown)

    def __contains__(self, identity: str) -> bool:
        return identity in self._shown

    @property
    def shapes(self) -> list[MarkerShape]:
        """The markers shown."""
        return [shape for _, shape in self._shown.values()]

    def put(self, shape: MarkerShape) -> None:
        """Show a marker, in place of that with its id."""
        self._change += 1
        self._gone.pop(shape.id, None)
        self._shown.pop(shape.id, None)  # so that what changed last stands last
        self._shown[shape.id] = (self._change, shape)

    def remove(self, identity: str) -> bool:
        """Remove a marker; False when it was not shown."""
        if self._shown.pop(identity, None) is None:
            return False
        self._change += 1
        self._gone.pop(identity, None)
        self._gone[identity] = self._change
        if len(self._gone) > _MOST_GONE:
            self._oldest = self._gone.pop(next(iter(self._gone)))
        return True

    def clear(self) -> None:
        """Show none."""
        self._change += 1
        self._oldest = self._change
        self._shown.clear()
        self._gone.clear()

    def since(self, seen: int) -> tuple[bytes | None, int]:
        """What a page lacks that has seen the changes up to one."""
        if seen == self._change:
            return None, seen
        if self._packed is None or self._packed[:2] != (seen, self._change):
            self._packed = (seen, self._change, self._pack(seen))
        return self._packed[2], self._change

    def _pack(self, seen: int) -> bytes:
        everything = seen < self._oldest or seen == 0
        return pack_data(
            self._display,
            MarkersChanged(
                everything=everything,
                gone=[] if everything else _newer(self._gone, seen),
                markers=[shape for change, shape in self._shown.values() if everything or change > seen],
            ),
        )


def _newer(changes: dict[str, int], seen: int) -> list[str]:
    return [identity for identity, change in changes.items() if change > seen]
