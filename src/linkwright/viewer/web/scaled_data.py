"""Content that can be reduced: each page gets as much of it as its connection carries."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import cached_property

from linkwright.viewer.protocol.message import DataContent

Pack = Callable[[DataContent], bytes]
Shrink = Callable[[int], DataContent]
"""Reduces the content to about so many bytes, or as far as it can be; runs in a thread."""


class ScaledData:
    """One content of a display, packed for a page when its turn comes.

    Args:
        key: under which it waits in outboxes.
        content: all of it.
        shrink: makes less of it.
        pack: makes the binary frame.

    Attributes:
        gone: it was replaced or taken away, and is not to be sent again.
    """

    def __init__(self, key: str, content: DataContent, shrink: Shrink, pack: Pack) -> None:
        self.key = key
        self.gone = False
        self._content = content
        self._shrink = shrink
        self._pack = pack
        self._smaller: dict[int, asyncio.Future[bytes]] = {}

    @cached_property
    def whole(self) -> bytes:
        """The frame with all of it."""
        return self._pack(self._content)

    async def fitting(self, room: int) -> bytes:
        """The frame with as much as goes into so many bytes; what pages of like lines get is made once."""
        if len(self.whole) <= room:
            return self.whole
        size = 1 << (room.bit_length() - 1)
        if size not in self._smaller:
            self._smaller[size] = asyncio.ensure_future(asyncio.to_thread(self._made, size))
        return await asyncio.shield(self._smaller[size])

    def _made(self, size: int) -> bytes:
        return self._pack(self._shrink(size))
