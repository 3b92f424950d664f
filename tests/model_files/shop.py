"""A server of models on this machine, which can be told to break, and models that it has."""

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


def archive(files=FILES, folder="toy-1.0", **more: bytes) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as opened:
        for name, data in files.items():
            opened.writestr(f"{folder}/{name}", data)
        for name, data in more.items():
            opened.writestr(name, data)
    return packed.getvalue()


ARCHIVE = archive()

PACKED = ModelEntry(
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
SINGLE = ModelEntry(
    name="toy-net",
    kind="vision",
    address="unset",
    megabytes=1,
    license="Apache-2.0",
    purpose="tests",
    sha256=sha256(b"network" * 1_000),
)


class Shop:
    """What is served below ``/``, and how.

    Attributes:
        files: content by name.
        asked: the Range of each request, None for none.
        breaks: after how many bytes each of the next connections breaks off.
        ranges: whether it can begin in the middle of a file.
    """

    def __init__(self) -> None:
        self.files: dict[str, bytes] = {}
        self.asked: list[str | None] = []
        self.breaks: list[int] = []
        self.ranges = True
        self.address = ""

    def of(self, entry: ModelEntry, name: str, data: bytes) -> ModelEntry:
        """The model, offered here."""
        self.files[name] = data
        return replace(entry, address=f"{self.address}/{name}")

    async def serve(self, request: web.Request) -> web.StreamResponse:
        self.asked.append(wanted := request.headers.get("Range"))
        data = self.files.get(request.match_info["name"])
        if data is None:
            raise web.HTTPNotFound
        first = int(wanted.removeprefix("bytes=").rstrip("-")) if wanted and self.ranges else 0
        if first and first >= len(data):
            return web.Response(status=416, headers={"Content-Range": f"bytes */{len(data)}"})
        response = web.StreamResponse(status=206 if first else 200)
        response.content_length = len(data) - first
        await response.prepare(request)
        if self.breaks:
            await response.write(data[first : first + self.breaks.pop(0)])
            request.transport.close()
            return response
        await response.write(data[first:])
        return response


@contextmanager
def open_shop() -> Iterator[Shop]:
    """A shop in a thread of its own, because those who fetch wait for it."""
    shop = Shop()
    loop = asyncio.new_event_loop()

    async def start() -> web.AppRunner:
        app = web.Application()
        app.router.add_get("/{name}", shop.serve)
        runner = web.AppRunner(app)
        await runner.setup()
        site = web.TCPSite(runner, "127.0.0.1", 0)
        await site.start()
        host, port = runner.addresses[0][:2]
        shop.address = f"http://{host}:{port}"
        return runner

    runner = loop.run_until_complete(start())
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    try:
        yield shop
    finally:
        asyncio.run_coroutine_threadsafe(runner.cleanup(), loop).result()
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()
