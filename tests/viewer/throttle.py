"""A slow connection between a page and the server; for tests."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from urllib.parse import urlsplit

_BUFFER_BYTES = 8192


@asynccontextmanager
async def slow_line(url: str, rate: float) -> AsyncIterator[str]:
    """Return the address of a proxy for a server.

    The proxy limits the bytes per second from the server.
    """
    address = urlsplit(url)
    tasks: set[asyncio.Task] = set()

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        upstream = socket.socket()
        upstream.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _BUFFER_BYTES)
        upstream.setblocking(False)
        await asyncio.get_running_loop().sock_connect(upstream, (address.hostname, address.port))
        from_server, to_server = await asyncio.open_connection(sock=upstream, limit=_BUFFER_BYTES)
        for work in (copy(reader, to_server, 0.0), copy(from_server, writer, rate)):
            task = asyncio.ensure_future(work)
            tasks.add(task)
            task.add_done_callback(tasks.discard)

    async def copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, limit: float) -> None:
        loop = asyncio.get_running_loop()
        due = loop.time()
        with suppress(ConnectionError, asyncio.CancelledError):
            while data := await reader.read(2048):
                if limit:
                    due = max(due, loop.time()) + len(data) / limit
                    await asyncio.sleep(due - loop.time())
                writer.write(data)
                await writer.drain()
        writer.close()

    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    port = server.sockets[0].getsockname()[1]
    try:
        yield f"http://127.0.0.1:{port}/?{address.query}"
    finally:
        server.close()
        for task in list(tasks):
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
