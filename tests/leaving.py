"""Clients that send a request and reset the connection before the response."""

from __future__ import annotations

import asyncio
import socket
import struct

STEP_COUNT = 12
"""The number of clients. Client n leaves after n turns of the event loop: while the server reads, or responds."""

_RESET_AT_ONCE = struct.pack("ii", 1, 0)
UPGRADE = (
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
)


async def request_and_reset(port: int, target: str, headers: str = "") -> None:
    """Send three requests to a local port and reset the connection.

    The resets come after different numbers of turns of the event loop.

    The server runs on the event loop of the caller.
    """
    request = f"GET {target} HTTP/1.1\r\nHost: localhost\r\n{headers}\r\n".encode()
    for steps in range(STEP_COUNT):
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        client = writer.get_extra_info("socket")
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, _RESET_AT_ONCE)
        writer.write(request * 3)
        for _ in range(steps):
            await asyncio.sleep(0)
        writer.transport.abort()
