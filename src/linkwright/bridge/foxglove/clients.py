"""Connected clients, each with a send queue."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from aiohttp.web import WebSocketResponse

_MOST_CONTROL = 4096
"""Messages other than data that may wait; a client that leaves more unread is cut off."""


class Client:
    """A connection to a client.

    If a client reads too slowly, the oldest queued topic messages are dropped; other messages stay in the queue.

    Args:
        socket: the WebSocket of the client.
        most_bytes: the maximum number of bytes of topic messages in the queue.
    """

    def __init__(self, socket: WebSocketResponse, most_bytes: int) -> None:
        self._socket = socket
        self._most = most_bytes
        self._control: deque[str | bytes] = deque()
        self._data: deque[bytes] = deque()
        self._bytes = 0
        self._filled = asyncio.Event()

    def send(self, message: dict[str, Any] | bytes) -> None:
        """Queue a message that is never dropped."""
        made = message if isinstance(message, bytes) else json.dumps(message, ensure_ascii=False)
        self._control.append(made)
        self._filled.set()

    def send_data(self, frame: bytes) -> None:
        """Queue a message of a topic, which is dropped if the client is too slow."""
        self._data.append(frame)
        self._bytes += len(frame)
        while self._bytes > self._most and len(self._data) > 1:
            self._bytes -= len(self._data.popleft())
        self._filled.set()

    async def write(self) -> None:
        """Send the queued messages until the connection ends."""
        with suppress(ConnectionError):
            while True:
                if len(self._control) > _MOST_CONTROL:
                    await self._socket.close(code=1008, message=b"too much was left unread")
                    return
                if self._control:
                    message = self._control.popleft()
                elif self._data:
                    message = self._data.popleft()
                    self._bytes -= len(message)
                else:
                    self._filled.clear()
                    await self._filled.wait()
                    continue
                if isinstance(message, bytes):
                    await self._socket.send_bytes(message)
                else:
                    await self._socket.send_str(message)
