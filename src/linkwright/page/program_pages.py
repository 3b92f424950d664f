"""The pages of programs in the terminals of a page, which shows them in frames.

The shells of the terminals have an environment variable with an address of the server, which cannot be guessed. A
program that would open its page in the browser sends the address of its page there instead. This request lasts as long
as the program, so that the server notices its end, even if it was killed. The program allows only pages of the
server's origin to show its page in a frame.

The response also stays open. In it, the server asks the program to pause its world and to resume it. A program confirms
a pause in another line of its request.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import re
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from linkwright.page.access import PROGRAM_PAGES_PATH, PROGRAM_PAGES_VARIABLE

if TYPE_CHECKING:
    from linkwright.page.http_server import web
    from linkwright.page.protocol.terminal import ProgramPage

_PAGE_ADDRESS = re.compile(r"http://(127\.0\.0\.1|localhost):\d{1,5}/\?token=[\w-]+")
_SERVER_ADDRESS = re.compile(rf"http://(127\.0\.0\.1|localhost|\[::1\]):\d{{1,5}}{PROGRAM_PAGES_PATH}[\w-]+")
_MAX_TITLE_LENGTH = 200
_PAUSE, _RESUME, _PAUSED = b"pause\n", b"resume\n", b"paused\n"
_TIMEOUT_S = 3.0
"""Seconds to wait for a program's address, and for the server's answer to it."""


class ProgramPages:
    """The server's record of the pages of programs, which it shows in frames.

    Attributes:
        is_shown: returns whether an open page can show the pages of programs, which are refused otherwise.
        on_change: called when a program has sent the address of its page, and when it has ended.
        on_pause: called when a program has paused its world.
    """

    def __init__(self) -> None:
        self.is_shown: Callable[[], bool] = lambda: False
        self.on_change: Callable[[], object] = lambda: None
        self.on_pause: Callable[[], object] = lambda: None
        self._key = secrets.token_urlsafe(24)
        self._numbers = count(1)
        self._pages: dict[int, ProgramPage] = {}
        self._connections: set[asyncio.Transport] = set()
        self._responses: dict[int, web.StreamResponse] = {}
        self._paused: set[int] = set()
        self._must_pause = False
        self._tasks: set[asyncio.Task[None]] = set()

    @property
    def pages(self) -> list[ProgramPage]:
        """The pages of the programs that run, oldest first."""
        return list(self._pages.values())

    @property
    def is_world_paused(self) -> bool:
        """Whether a program has paused its world because of `pause_worlds`."""
        return bool(self._paused)

    def pause_worlds(self) -> None:
        """Ask all programs to pause their worlds.

        This includes programs that start before `resume_worlds` is called.
        """
        self._must_pause = True
        for response in self._responses.values():
            self._send(response, _PAUSE)

    def resume_worlds(self) -> None:
        """Ask all programs to resume the worlds that they have paused because of `pause_worlds`."""
        if self._must_pause:
            self._must_pause = False
            self._paused.clear()
            for response in self._responses.values():
                self._send(response, _RESUME)

    def make_variables(self, origin: str) -> dict[str, str]:
        """Return the environment variables for programs whose pages a page of an origin shows."""
        return {PROGRAM_PAGES_VARIABLE: f"{origin}{PROGRAM_PAGES_PATH}{self._key}"}

    def is_key(self, key: str) -> bool:
        """Return whether a key matches the address in `make_variables`."""
        return hmac.compare_digest(key.encode(errors="replace"), self._key.encode())

    async def receive(self, request: web.Request) -> web.StreamResponse:
        """Show the page whose address a program sends, until the request ends."""
        from linkwright.page.http_server import web

        page = await self._read_page(request)
        if page is None:
            return web.Response(status=400, text="This is not the address of a page on this machine.\n")
        if not self.is_shown():
            return web.Response(status=503, text="No page is open.\n")
        response = web.StreamResponse()
        await response.prepare(request)
        await response.write(b"\n")
        transport = request.transport
        if transport is None:
            return response
        self._pages[page.id], self._responses[page.id] = page, response
        self._connections.add(transport)
        self.on_change()
        try:
            if self._must_pause:
                self._send(response, _PAUSE)
            with suppress(ConnectionError, web.RequestPayloadError, ValueError):  # ValueError: a line is too long
                while line := await request.content.readline():
                    self._read_line(page.id, line)
        finally:
            del self._pages[page.id], self._responses[page.id]
            self._paused.discard(page.id)
            self._connections.discard(transport)
            self.on_change()
        return response

    def close(self) -> None:
        """Close the connections to programs, which continue."""
        for transport in self._connections:
            transport.abort()

    def _read_line(self, page_id: int, line: bytes) -> None:
        if line == _PAUSED and self._must_pause:
            self._paused.add(page_id)
            self.on_pause()

    def _send(self, response: web.StreamResponse, line: bytes) -> None:
        async def write() -> None:
            with suppress(ConnectionError):
                await response.write(line)

        task = asyncio.get_running_loop().create_task(write())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _read_page(self, request: web.Request) -> ProgramPage | None:
        """Return the page in the first line of a request, or None if the line is not valid."""
        try:
            content = json.loads(await asyncio.wait_for(request.content.readline(), _TIMEOUT_S))
            title, url = str(content["title"]), str(content["url"])
        except (asyncio.TimeoutError, ConnectionError, ValueError, TypeError, KeyError, RecursionError):
            return None
        if not _PAGE_ADDRESS.fullmatch(url):
            return None
        from linkwright.page.protocol.terminal import ProgramPage

        return ProgramPage(next(self._numbers), title[:_MAX_TITLE_LENGTH], url)


@dataclass(frozen=True)
class Embedder:
    """The page in whose terminal this program runs.

    Attributes:
        origin: the origin of the page, which may show pages of this program in frames.
        path: the path on its server to which addresses are sent.
    """

    origin: str
    path: str

    @classmethod
    def of(cls, environment: Mapping[str, str]) -> Embedder | None:
        """Return the page that the environment variables name, or None if they name none."""
        address = environment.get(PROGRAM_PAGES_VARIABLE, "")
        if not _SERVER_ADDRESS.fullmatch(address):
            return None
        origin, _, key = address.rpartition(PROGRAM_PAGES_PATH)
        return cls(origin, PROGRAM_PAGES_PATH + key)

    async def show(self, url: str, title: str) -> Embedding | None:
        """Let the page show a page of this program in a frame.

        Returns:
            The connection, which the caller must keep open for as long as the page is to be shown; None if the page
            is not shown.
        """
        try:
            return await asyncio.wait_for(self._show(url, title), _TIMEOUT_S)
        except (asyncio.TimeoutError, OSError, ValueError):
            return None

    async def _show(self, url: str, title: str) -> Embedding | None:
        server = urlsplit(self.origin)
        line = json.dumps({"title": title, "url": url}) + "\n"
        head = f"POST {self.path} HTTP/1.1\r\nHost: {server.netloc}\r\nTransfer-Encoding: chunked\r\n\r\n"
        reader, writer = await asyncio.open_connection(server.hostname, server.port)
        is_shown = False
        try:
            writer.write(head.encode("ascii") + _encode_chunk(line.encode("ascii")))  # the body ends with the program
            status = await reader.readline()
            is_shown = status.split(b" ")[1:2] == [b"200"]
        finally:
            if not is_shown:
                writer.close()
        return Embedding(reader, writer) if is_shown else None


class Embedding:
    """The connection to the page that shows a page of this program.

    Attributes:
        on_pause: called with True to pause the world of this program, or False to resume it; returns whether the world
            is paused because of this call.
    """

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.on_pause: Callable[[bool], bool] = lambda _: False
        self._writer = writer
        self._task = asyncio.get_running_loop().create_task(self._read(reader))

    def close(self) -> None:
        """Close the connection. The page around it then removes the frame."""
        self._task.cancel()
        self._writer.close()

    async def _read(self, reader: asyncio.StreamReader) -> None:
        """Handle the lines of the response, and resume the world at its end."""
        with suppress(ConnectionError, ValueError):
            while line := await reader.readline():
                if line in (_PAUSE, _RESUME) and self.on_pause(line == _PAUSE):
                    self._writer.write(_encode_chunk(_PAUSED))
        self.on_pause(False)


def _encode_chunk(content: bytes) -> bytes:
    """Return a part of a body with the transfer encoding ``chunked``."""
    return b"%x\r\n%b\r\n" % (len(content), content)
