"""What waits to be sent to one page: of each kind only the newest, transforms before the rest."""

from __future__ import annotations

import asyncio

FRAME_TABLE = "frame_table"
TRANSFORMS = "transforms"
_URGENT = (FRAME_TABLE, TRANSFORMS)

Payload = str | bytes
"""Text of a control message, or a binary frame."""


class Outbox:
    """Payloads by redundancy key.

    A payload replaces one that waits under its key and goes to the end, so that what is sent is in the order in which
    it came to be. Frame tables and transforms wait in a line of their own, from which every other payload is taken: a
    slider moves the picture before anything else is sent, yet a slow page does not starve of the rest.
    """

    def __init__(self) -> None:
        self._urgent: dict[str, Payload] = {}
        self._ordinary: dict[str, Payload] = {}
        self._filled = asyncio.Event()
        self._urgent_last = False

    def __len__(self) -> int:
        return len(self._urgent) + len(self._ordinary)

    def put(self, key: str, payload: Payload) -> None:
        """Have a payload sent, instead of one that waits under the same key."""
        line = self._urgent if key in _URGENT else self._ordinary
        line.pop(key, None)
        line[key] = payload
        self._filled.set()

    async def take(self) -> Payload:
        """The next payload, as soon as there is one."""
        while not len(self):
            self._filled.clear()
            await self._filled.wait()
        self._urgent_last = bool(self._urgent) and not (self._urgent_last and self._ordinary)
        line = self._urgent if self._urgent_last else self._ordinary
        return line.pop(next(iter(line)))
