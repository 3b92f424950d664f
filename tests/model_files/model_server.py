"""An HTTP server on localhost that serves model files and can drop connections."""

from __future__ import annotations

import asyncio
import hashlib
import io
import threading
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from aiohttp import web

from linkwright.model_files import ModelEntry

FILES = {"am/final.mdl": b"acoustic" * 5_000, "conf/model.conf": b"--beam=10\n", "ivector/online_cmvn.conf": b""}


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def archive(files=FILES, folder="toy-1.0", **extra_files: bytes) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as zip_file:
        for name, data in files.items():
            zip_file.writestr(f"{folder}/{name}", data)
        for name, data in extra_files.items():
            zip_file.writestr(name, data)
    return buffer.getvalue()


ARCHIVE = archive()

ARCHIVE_ENTRY = ModelEntry(
    name="toy",
    kind="speech",
    address="unset",
    megabytes=1,
    license="Apache-2.0",
    purpose="tests",
    folder="toy-1.0",
    sha256=sha256(ARCHIVE),
    files={name: sha256(data) for name, data in FILES.items()},
)
FILE_ENTRY = ModelEntry(
    name="toy-net",
    kind="vision",
    address="unset",
    megabytes=1,
    license="Apache-2.0",
    purpose="tests",
    sha256=sha256(b"network" * 1_000),
)


class ModelServer:
    """An HTTP server with its files.

    Attributes:
        files: the content of each file, by name.
        range_headers: the Range header of each request, or None.
        disconnect_after: for each of the next connections, the number of bytes after which it is dropped.
        supports_ranges: whether a download can begin in the middle of a file.
        address: the server's address, without a slash at the end.
    """

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.range_headers: list[str | None] = []
        self.disconnect_after: list[int] = []
        self.supports_ranges = True
        self.address = ""

    def add(self, entry: ModelEntry, name: str, data: bytes) -> ModelEntry:
        """Serve a file, and return the entry with its address."""
        self.files[name] = data
        return replace(entry, address=f"{self.address}/{name}")

    async def serve(self, request: web.Request) -> web.StreamResponse:
        self.range_headers.append(range_header := request.headers.get("Range"))
        data = self.files.get(request.match_info["name"])
        if data is None:
            raise web.HTTPNotFound
        first = int(range_header.removeprefix("bytes=").rstrip("-")) if range_header and self.supports_ranges else 0
        if first and first >= len(data):
            return web.Response(status=416, headers={"Content-Range": f"bytes */{len(data)}"})
        response = web.StreamResponse(status=206 if first else 200)
        response.content_length = len(data) - first
        await response.prepare(request)
        if self.disconnect_after:
            await response.write(data[first : first + self.disconnect_after.pop(0)])
            request.transport.close()
            return response
        await response.write(data[first:])
        return response


@contextmanager
def run_model_server() -> Iterator[ModelServer]:
    """Run the server in a thread, because the download blocks."""
    server = ModelServer()
    loop = asyncio.new_event_loop()

    async def start() -> web.AppRunner:
        app = web.Application()
        app.router.add_get("/{name}", server.serve)
        runner = web.AppRunner(app)
        await runner.setup()
        site = web.TCPSite(runner, "127.0.0.1", 0)
        await site.start()
        host, port = runner.addresses[0][:2]
        server.address = f"http://{host}:{port}"
        return runner

    runner = loop.run_until_complete(start())
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    try:
        yield server
    finally:
        asyncio.run_coroutine_threadsafe(runner.cleanup(), loop).result()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()
