"""The pages of programs in the terminals of a page, which shows them in frames.

The shells of the terminals have an environment variable with an address of the server, which cannot be guessed. A
program that would open its page in the browser sends the address of its page there instead. This request lasts as long
as the program, so that the server notices its end, even if it was killed. The program allows only pages of the
server's origin to show its page in a frame.
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
_TIMEOUT = 3.0
"""Seconds to wait for a program's address, and for the server's answer to it."""


class ProgramPages:
    """The server's record of the pages of programs, which it shows in frames.

    Attributes:
        is_shown: returns whether an open page can show the pages of programs, which are refused otherwise.
        on_change: called when a program has sent the address of its page, and when it has ended.
    """

    def __init__(self) -> None:
        self.is_shown: Callable[[], bool] = lambda: False
        self.on_change: Callable[[], object] = lambda: None
        self._key = secrets.token_urlsafe(24)
        self._numbers = count(1)
        self._pages: dict[int, ProgramPage] = {}
        self._connections: set[asyncio.Transport] = set()

    @property
    def pages(self) -> list[ProgramPage]:
        """The pages of the programs that run, oldest first."""
        return list(self._pages.values())

    def variables(self, origin: str) -> dict[str, str]:
        """Return the environment variables for programs whose pages are shown in a page of an origin."""
        return {PROGRAM_PAGES_VARIABLE: f"{origin}{PROGRAM_PAGES_PATH}{self._key}"}

    def is_key(self, key: str) -> bool:
        """Return whether a key is that of the address in `variables`."""
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
        self._pages[page.id] = page
        self._connections.add(transport)
        self.on_change()
        try:
            with suppress(ConnectionError, web.RequestPayloadError):
                while await request.content.readany():
                    pass
        finally:
            del self._pages[page.id]
            self._connections.discard(transport)
            self.on_change()
        return response

    def close(self) -> None:
        """Close the connections to programs, which continue."""
        for transport in self._connections:
            transport.abort()

    async def _read_page(self, request: web.Request) -> ProgramPage | None:
        """Return the page in the first line of a request, or None if the line is not valid."""
        try:
            content = json.loads(await asyncio.wait_for(request.content.readline(), _TIMEOUT))
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
        """Return the page that the environment variables name, or None if they do not."""
        address = environment.get(PROGRAM_PAGES_VARIABLE, "")
        if not _SERVER_ADDRESS.fullmatch(address):
            return None
        origin, _, key = address.rpartition(PROGRAM_PAGES_PATH)
        return cls(origin, PROGRAM_PAGES_PATH + key)

    async def show(self, url: str, title: str) -> asyncio.StreamWriter | None:
        """Let the page show a page of this program in a frame.

        Returns:
            The connection, which the caller must keep open for as long as the page is to be shown; None if the page
            is not shown.
        """
        try:
            return await asyncio.wait_for(self._show(url, title), _TIMEOUT)
        except (asyncio.TimeoutError, OSError, ValueError):
            return None

    async def _show(self, url: str, title: str) -> asyncio.StreamWriter | None:
        server = urlsplit(self.origin)
        line = json.dumps({"title": title, "url": url}) + "\n"
        head = f"POST {self.path} HTTP/1.1\r\nHost: {server.netloc}\r\nTransfer-Encoding: chunked\r\n\r\n"
        reader, writer = await asyncio.open_connection(server.hostname, server.port)
        is_shown = False
        try:
            writer.write(f"{head}{len(line):x}\r\n{line}\r\n".encode("ascii"))  # the body ends with the program
            status = await reader.readline()
            is_shown = status.split(b" ")[1:2] == [b"200"]
        finally:
            if not is_shown:
                writer.close()
        return writer if is_shown else None
