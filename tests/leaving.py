"""Clients that ask a server and leave, with a reset, before they have their answer."""

from __future__ import annotations

import asyncio
import socket
import struct

STEPS = 12
"""One client for each number of steps of the event loop before it leaves: that covers reading and answering."""

_RESET_AT_ONCE = struct.pack("ii", 1, 0)
UPGRADE = (
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
)


async def ask_and_leave(port: int, target: str, headers: str = "") -> None:
    """Ask for something on this machine's `port` three times over and leave, sooner and later.

    The server runs on the event loop of the caller.
    """
    request = f"GET {target} HTTP/1.1\r\nHost: localhost\r\n{headers}\r\n".encode()
    for steps in range(STEPS):
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        client = writer.get_extra_info("socket")
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET_AT_ONCE)
        writer.write(request * 3)
        for _ in range(steps):
            await asyncio.sleep(0)
        writer.transport.abort()
