"""Pings with which a server finds clients that no longer answer."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aiohttp.web import WebSocketResponse


class Pings:
    """Pings a client, and ends its connection if nothing arrives from it for too long.

    Args:
        socket: the WebSocket of the client.
        interval_s: the seconds between pings; None for no pings.
        timeout_s: the seconds without a message of the client after which the connection ends; None for no pings.
    """

    def __init__(self, socket: WebSocketResponse, interval_s: float | None, timeout_s: float | None) -> None:
        self._socket = socket
        self._interval_s = interval_s
        self._timeout_s = timeout_s
        self._loop = asyncio.get_running_loop()
        self._received_s = self._loop.time()

    def on_message(self) -> None:
        """Note that the client has sent something, such as the answer to a ping."""
        self._received_s = self._loop.time()

    async def send(self) -> None:
        """Send pings until the connection ends, or end it."""
        if not self._interval_s or not self._timeout_s:
            return
        with suppress(ConnectionError):
            await asyncio.sleep(self._interval_s)
            while True:
                await self._socket.ping()
                due_s = self._loop.time() + self._interval_s
                while (remaining_s := due_s - self._loop.time()) > 0:
                    silent_s = self._loop.time() - self._received_s
                    if silent_s >= self._interval_s + self._timeout_s:
                        await self._socket.close(code=1001, message=b"the client does not answer pings")
                        return
                    await asyncio.sleep(min(remaining_s, self._interval_s + self._timeout_s - silent_s))
