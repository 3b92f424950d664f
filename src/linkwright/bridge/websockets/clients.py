"""Connected clients, each with a send queue."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from aiohttp.web import WebSocketResponse

_MAX_CONTROL_MESSAGES = 4096
"""The maximum number of queued messages that are not data. A client that leaves more unread is disconnected."""


class Client:
    """A connection to a client.

    If a client reads too slowly, the oldest queued topic messages are dropped; other messages stay in the queue.

    Args:
        socket: the WebSocket of the client.
        max_bytes: the maximum number of bytes of topic messages in the queue.
        send_delay: the seconds to wait after each frame.
    """

    def __init__(self, socket: WebSocketResponse, max_bytes: int, send_delay: float = 0.0) -> None:
        self._socket = socket
        self._max_bytes = max_bytes
        self._send_delay = send_delay
        self._control: deque[str | bytes] = deque()
        self._data: deque[tuple[str | bytes, ...]] = deque()
        self._queued_bytes = 0
        self._has_messages = asyncio.Event()

    def send(self, message: dict[str, Any] | str | bytes) -> None:
        """Queue a message that is never dropped."""
        self._control.append(json.dumps(message, ensure_ascii=False) if isinstance(message, dict) else message)
        self._has_messages.set()

    def send_data(self, *frames: str | bytes) -> None:
        """Queue a message of a topic, which consists of one frame or several.

        The oldest messages are dropped if the client is too slow.
        """
        self._data.append(frames)
        self._queued_bytes += sum(map(len, frames))
        while self._queued_bytes > self._max_bytes and len(self._data) > 1:
            self._queued_bytes -= sum(map(len, self._data.popleft()))
        self._has_messages.set()

    async def write(self) -> None:
        """Send the queued messages until the connection ends."""
        with suppress(ConnectionError):
            while True:
                if len(self._control) > _MAX_CONTROL_MESSAGES:
                    await self._socket.close(code=1008, message=b"the client reads messages too slowly")
                    return
                if self._control:
                    await self._send_frame(self._control.popleft())
                elif self._data:
                    frames = self._data.popleft()
                    self._queued_bytes -= sum(map(len, frames))
                    for frame in frames:
                        await self._send_frame(frame)
                else:
                    self._has_messages.clear()
                    await self._has_messages.wait()

    async def _send_frame(self, frame: str | bytes) -> None:
        if isinstance(frame, bytes):
            await self._socket.send_bytes(frame)
        else:
            await self._socket.send_str(frame)
        if self._send_delay > 0:
            await asyncio.sleep(self._send_delay)
