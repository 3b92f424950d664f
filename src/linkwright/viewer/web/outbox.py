"""What waits to be sent to one page: of each kind only the newest, transforms before the rest."""

from __future__ import annotations

import asyncio
from typing import Protocol

from linkwright.viewer.web.scaled_data import ScaledData

FRAME_TABLE = "frame_table"
TRANSFORMS = "transforms"
_URGENT = (FRAME_TABLE, TRANSFORMS)

Made = str | bytes
"""Text of a control message, or a binary frame."""


class Changes(Protocol):
    """Content that is sent as changes: each page gets what it lacks, put together when its turn comes.

    A slow page so gets many changes in one frame, and nothing that has gone again meanwhile.
    """

    key: str
    """Under which it waits."""

    def since(self, seen: int) -> tuple[Made | None, int]:
        """The message or binary frame for a page.

        Args:
            seen: what this returned when the page was sent the last one; 0 for a page that has nothing.

        Returns:
            The frame, or None when the page has everything; and what the page will have seen then.
        """


Payload = Made | Changes | ScaledData


class Outbox:
    """Payloads by redundancy key.

    A payload replaces one that waits under its key and goes to the end, so that what is sent is in the order in which
    it came to be; heavy content keeps the place, or that which comes most often would starve the rest. Frame tables and
    transforms wait in a line of their own, from which every other payload is taken: a slider moves the picture before
    anything else is sent, yet a slow page does not starve of the rest.

    Attributes:
        is_held: the line is full: only frame tables and transforms are taken.
    """

    def __init__(self) -> None:
        self._urgent: dict[str, Payload] = {}
        self._ordinary: dict[str, Payload] = {}
        self._filled = asyncio.Event()
        self._urgent_last = False
        self._seen: dict[str, int] = {}
        self.is_held = False

    def __len__(self) -> int:
        return len(self._urgent) + len(self._ordinary)

    def put(self, key: str, payload: Payload) -> None:
        """Have a payload sent, instead of one that waits under the same key."""
        line = self._urgent if key in _URGENT else self._ordinary
        before = line.get(key)
        if not (isinstance(before, ScaledData) and isinstance(payload, ScaledData) and not before.gone):
            line.pop(key, None)
        line[key] = payload
        self._filled.set()

    def __contains__(self, key: str) -> bool:
        return key in self._urgent or key in self._ordinary

    def hold(self, held: bool) -> None:
        """Have only frame tables and transforms taken, or everything again."""
        self.is_held = held
        self._filled.set()

    async def take(self) -> Made | ScaledData:
        """The next payload, as soon as there is one."""
        while True:
            while not self._urgent and (self.is_held or not self._ordinary):
                self._filled.clear()
                await self._filled.wait()
            others = self._ordinary and not self.is_held
            self._urgent_last = bool(self._urgent) and not (self._urgent_last and others)
            line = self._urgent if self._urgent_last else self._ordinary
            made = self.make(line.pop(next(iter(line))))
            if made is not None:
                return made

    def make(self, payload: Payload) -> Made | ScaledData | None:
        """What is sent for a payload now; None when that is nothing."""
        if isinstance(payload, (str, bytes)):
            return payload
        if isinstance(payload, ScaledData):
            return None if payload.gone else payload
        made, self._seen[payload.key] = payload.since(self._seen.get(payload.key, 0))
        return made
