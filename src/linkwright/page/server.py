"""The web server: its listening socket, the page, the page's WebSocket, and files for the page."""

from __future__ import annotations

import asyncio
import errno
import gzip
import ipaddress
import os
import re
import socket
import stat
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, cast
from urllib.parse import quote

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.page.access import TOKEN_PARAMETER, Admission, Gate, security_headers
from linkwright.page.files import CONTENT_TYPES, IMAGE_TYPES, Downloads, FileRefusedError, MeshFolders
from linkwright.page.http_server import SERVER_LOGGER, web

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping

    from linkwright.page.audience import Audience
    from linkwright.page.uploads import Guests, Uploads

PAGE_FOLDER = Path(__file__).parent / "built"
"""The folder into which ``frontend/`` is built."""

MAXIMUM_MESSAGE = 1024 * 1024
"""Longest message accepted from a page, bytes: a configuration file. A longer one ends the connection (1009)."""

_OWN_KEY = re.compile(r"[0-9A-Za-z-]{8,64}")
_HEARTBEAT = 15.0
_IDLE = 30.0
"""Seconds that a connection may wait for its next request."""

_BACKLOG = 128
_BLOCK = 256 * 1024
"""Bytes of a long file that are read at once."""

_LEAST_PACKED, _WORTH_PACKING, _PACKING_LEVEL = 4096, 0.9, 1
"""Meshes from so many bytes on go compressed, where so small a part of them is left. The next levels take twice the
time and save another tenth."""

_GOODBYE = 0.5
"""Seconds a page has to answer a closing handshake, and a request to end."""

_NOT_BUILT = """\
The page of this viewer has not been built.

In a checkout of Linkwright run

    make page

and reload. An installed wheel carries the page; if you see this there, the wheel was built without it.
"""
_PAGE_TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".map": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
    ".woff": "font/woff",
    ".wasm": "application/wasm",
    ".webmanifest": "application/manifest+json",
    ".txt": "text/plain; charset=utf-8",
}

DEFAULT_PORT = 7448
"""Beside 7447, where routers of Zenoh listen (decision 0066)."""

_TRIES = 10
_WILDCARDS = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - what an address to open is instead of

MOST_UNSENT = 16 * 1024
"""Bytes that may wait in the program, and again as many in the operating system, before the writer must wait."""

_NOT_SENT_LOW_WATER: int | None = getattr(socket, "TCP_NOTSENT_LOWAT", None)


@dataclass(slots=True)
class _Shown:
    """The services for pages: the audience that serves their WebSockets, and the guests.

    The guests show recordings that pages upload. `uploads` is created by the first upload request.
    """

    audience: Audience
    guests: Guests | None
    uploads: Uploads | None = None


class WebServer:
    """Serves one viewer, and the files of the page even before the viewer exists.

    Args:
        gate: checks requests.
        meshes: the folders that pages may read from.
        downloads: files that were generated for pages.
        page_folder: the folder of the built page.
    """

    def __init__(self, gate: Gate, meshes: MeshFolders, downloads: Downloads, page_folder: Path = PAGE_FOLDER) -> None:
        self._gate = gate
        self._meshes = meshes
        self._downloads = downloads
        self._page_folder = page_folder
        self._shown: asyncio.Future[_Shown] = asyncio.get_running_loop().create_future()
        self._runner: web.AppRunner | None = None
        self._listening: asyncio.Server | None = None
        self._admission: Admission | None = None
        self._page_contents: dict[tuple[Path, bool], _FileRead] = {}
        self._reading = asyncio.Lock()

    async def start(self, listener: socket.socket) -> str:
        """Serve on a listening socket, and return the address to open, including the token.

        The socket is closed if this fails.
        """
        application = web.Application(middlewares=[self._guard])
        application.on_response_prepare.append(self._add_headers)
        application.router.add_get("/", self._index)
        application.router.add_get("/proof", self._proof, allow_head=False)
        application.router.add_get("/ws", self._socket, allow_head=False)
        application.router.add_get("/mesh/{key}/{path:.+}", self._mesh)
        application.router.add_get("/export/{key}/{name}", self._export, allow_head=False)
        for method, path, take in _UPLOADS:
            application.router.add_route(method, path, self._require_token(partial(self._upload, take)))
        application.router.add_post(
            "/export/{key}/{name}", self._require_token(partial(self._upload, self._show_own_recording))
        )
        application.router.add_get("/{path:.+}", self._page_file)
        self._runner = web.AppRunner(
            application,
            handle_signals=False,
            access_log=None,
            logger=SERVER_LOGGER,
            shutdown_timeout=_GOODBYE,
            keepalive_timeout=_IDLE,
        )
        try:
            await self._runner.setup()
            loop = asyncio.get_running_loop()
            self._admission = Admission(cast("web.Server", self._runner.server))
            self._listening = await loop.create_server(
                self._admission, sock=listener, backlog=_BACKLOG, start_serving=False
            )
            await self._listening.start_serving()
        except BaseException:
            try:
                await self.close()
            finally:
                listener.close()
            raise
        return f"{url_of(listener)}?{TOKEN_PARAMETER}={self._gate.token}"

    def show(self, audience: Audience, guests: Guests | None = None) -> None:
        """Admit pages, including those that are already waiting.

        Args:
            audience: serves the WebSockets of pages.
            guests: shows the recordings that pages upload; None if uploads are not accepted.
        """
        self._shown.set_result(_Shown(audience, guests))

    async def close(self) -> None:
        """Close the connections to pages, and stop serving."""
        if self._listening is not None:
            self._listening.close()
            self._listening = None
        if not self._shown.done():
            self._shown.cancel()
        elif not self._shown.cancelled():
            shown = self._shown.result()
            await shown.audience.close()
            if shown.uploads is not None:
                shown.uploads.close()
        if self._runner is not None:
            await self._runner.cleanup()
            self._runner = None

    # --- every request -----------------------------------------------------------------------------------------

    @web.middleware
    async def _guard(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        if self._admission is not None:
            self._admission.asked(request.protocol)
        reason = self._gate.refusal(request.headers)
        if reason is not None:
            return _refused(403, reason)
        if self._gate.is_shown_token(request.query):
            self._admit(request)
        return await handler(request)

    def _admit(self, request: web.Request) -> None:
        if self._admission is not None:
            self._admission.admit(request.protocol)

    async def _add_headers(self, request: web.Request, response: web.StreamResponse) -> None:
        host = request.host if self._gate.knows(request.host) else "localhost"
        response.headers.update(security_headers(host))
        response.headers.setdefault("Cache-Control", "no-store")

    # --- handlers of requests ----------------------------------------------------------------------------------

    async def _index(self, request: web.Request) -> web.StreamResponse:
        index = self._page_folder / "index.html"
        if not index.is_file():
            return web.Response(status=503, text=_NOT_BUILT)
        return await self._page_response(request, index, _PAGE_TYPES[".html"], "no-cache")

    async def _proof(self, request: web.Request) -> web.Response:
        """Prove to a page that knows the token that this program knows it too; see `Gate.proof`."""
        proof = self._gate.proof(request.query.get("nonce", ""))
        if proof is None:
            return web.Response(status=400, text="This address only answers the page.\n")
        return web.Response(text=proof)

    async def _page_file(self, request: web.Request) -> web.StreamResponse:
        path = request.match_info["path"]
        parts = path.split("/")
        content_type = _PAGE_TYPES.get(Path(parts[-1]).suffix)
        if content_type is None or any(part in ("", ".", "..") or "\0" in part or "\\" in part for part in parts):
            raise web.HTTPNotFound(text="There is no such page.\n")
        hashed = parts[0] == "assets"  # such names contain a hash of the content, by Vite
        cache = "private, max-age=31536000, immutable" if hashed else "no-cache"
        file = self._page_folder / path
        packed = file.with_name(f"{file.name}.gz")
        if not (hashed and packed.is_file()):
            return await self._page_response(request, file, content_type, cache)
        if not _takes_gzip(request):
            vary = {"Vary": "Accept-Encoding"}
            return await self._page_response(request, packed, content_type, cache, vary, unpack=True)
        # Compression reduces the files to a quarter, so that on a slow connection the page loads in seconds instead of
        # tens of
        # seconds.
        packing = {"Content-Encoding": "gzip", "Vary": "Accept-Encoding"}
        return await self._page_response(request, packed, content_type, cache, packing)

    async def _page_response(
        self,
        request: web.Request,
        path: Path,
        content_type: str,
        cache: str,
        packing: Mapping[str, str] | None = None,
        *,
        unpack: bool = False,
    ) -> web.StreamResponse:
        """Send a file of the page; concurrent requests share one copy of the file in memory."""
        async with self._reading:
            cached = self._page_contents.get((path, unpack))
            try:
                read = await asyncio.to_thread(_read, path, cached.tag if cached else "", unpack=unpack)
            except OSError:
                raise _no_file() from None
            if cached is None or read.body is not None:
                cached = self._page_contents[path, unpack] = read
        headers = {"Cache-Control": cache, "ETag": cached.tag, **(packing or {})}
        if cached.body is None or cached.is_known_to(request):
            return web.Response(status=304, headers=headers)
        response = web.StreamResponse(headers={**headers, "Content-Type": content_type})
        response.content_length = len(cached.body)
        await response.prepare(request)
        if request.method != "HEAD":
            content = memoryview(cached.body)
            for start in range(0, len(content), MOST_UNSENT):
                await response.write(content[start : start + MOST_UNSENT])
        await response.write_eof()
        return response

    async def _mesh(self, request: web.Request) -> web.StreamResponse:
        key, relative = request.match_info["key"], request.match_info["path"]
        try:
            path = await asyncio.to_thread(self._meshes.file, key, relative)
        except FileRefusedError as error:
            return web.Response(status=error.status, text=f"Refused: {error}.\n")
        self._admit(request)
        content_type = CONTENT_TYPES[path.suffix.lower()]
        packs = _takes_gzip(request) and path.suffix.lower() not in IMAGE_TYPES  # images are already compressed
        return await _file_response(request, path, content_type, "private, no-cache", packs=packs)

    async def _export(self, request: web.Request) -> web.StreamResponse:
        file = self._downloads.take(request.match_info["key"])
        recording = self._downloads.path(request.match_info["key"])
        if recording is not None:
            self._admit(request)
            return await _stream_file(request, recording)
        if file is None:
            raise web.HTTPNotFound(text="There is no such file; it can be fetched once.\n")
        self._admit(request)
        return web.Response(
            body=file.data, headers={"Content-Type": file.content_type, "Content-Disposition": _attached(file.name)}
        )

    async def _upload(
        self, take: Callable[[Uploads, web.Request], Awaitable[web.Response]], request: web.Request
    ) -> web.Response:
        shown = await self._viewer()
        if shown.guests is None:
            raise web.HTTPNotFound(text="This program does not accept recordings.\n")
        if shown.uploads is None:
            from linkwright.page.uploads import Uploads

            shown.uploads = Uploads(shown.guests)
        return await take(shown.uploads, request)

    async def _viewer(self) -> _Shown:
        """Wait until the services for pages are available, and return them."""
        try:
            return await asyncio.shield(self._shown)
        except asyncio.CancelledError:
            if not self._shown.cancelled():
                raise  # the client has disconnected
            raise web.HTTPServiceUnavailable(text="The program ends.\n") from None

    async def _show_own_recording(self, uploads: Uploads, request: web.Request) -> web.Response:
        """Show a recording that this program made, without an upload."""
        recording = self._downloads.path(request.match_info["key"])
        if recording is None:
            raise web.HTTPNotFound(text="There is no such recording.\n")
        return await uploads.show(request, recording)

    def _require_token(
        self, handler: Callable[[web.Request], Awaitable[web.Response]]
    ) -> Callable[[web.Request], Awaitable[web.StreamResponse]]:
        """Return a handler that calls another one only for requests with the token."""

        async def asked(request: web.Request) -> web.StreamResponse:
            return await handler(request) if self._gate.is_shown_token(request.query) else _without_token()

        return asked

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        if not self._gate.is_shown_token(request.query):
            return _without_token()
        shown = await self._viewer()
        from linkwright.page.audience import Page, requested_language

        audience = _audience_of(shown, request)
        if audience.is_full:
            return web.Response(status=503, text="Too many pages are open.\n")
        socket = web.WebSocketResponse(
            heartbeat=_HEARTBEAT,
            timeout=_GOODBYE,
            compress=False,
            max_msg_size=MAXIMUM_MESSAGE,
            writer_limit=MOST_UNSENT,
        )
        if not socket.can_prepare(request):
            return web.Response(status=400, text="This address is for the page's WebSocket.\n")
        with audience.expecting():
            await socket.prepare(request)
        if request.transport is not None:
            keep_short(request.transport)
        page = Page(
            socket, _own_displays(request), is_here=_is_from_here(request), language=requested_language(request)
        )
        await audience.attend(page, socket)
        return socket


_UPLOADS: tuple[tuple[str, str, Callable[[Uploads, web.Request], Awaitable[web.Response]]], ...] = (
    ("POST", "/recordings", lambda uploads, request: uploads.announce(request)),
    ("PUT", "/recordings/{key}/{number:[0-9]{1,4}}", lambda uploads, request: uploads.take(request)),
    ("POST", "/recordings/{key}", lambda uploads, request: uploads.open(request)),
    ("DELETE", "/recordings/{key}", lambda uploads, request: uploads.cancel_upload(request)),
)
"""Method, address and handler of the requests with which pages upload a recording."""


def _audience_of(shown: _Shown, request: web.Request) -> Audience:
    """Return the audience of the recording that a request names, if that is still shown.

    Otherwise, return the audience of the viewer.
    """
    key = request.query.get("recording", "")
    found = None if shown.guests is None or not key else shown.guests.audience(key)
    return shown.audience if found is None else found


def _is_from_here(request: web.Request) -> bool:
    """Return whether a request is from this machine: over loopback, or from the server's own address."""
    transport = request.transport
    peer, own = (transport and transport.get_extra_info(name) for name in ("peername", "sockname"))
    if not peer or not own:
        return False
    address = ipaddress.ip_address(peer[0].partition("%")[0])
    mapped = getattr(address, "ipv4_mapped", None)
    return (mapped or address).is_loopback or peer[0] == own[0]


def _own_displays(request: web.Request) -> str:
    """Return the name of the page's own configuration in its address; empty for the shared one."""
    key = request.query.get("own", "")
    return key if _OWN_KEY.fullmatch(key) else ""


def _takes_gzip(request: web.Request) -> bool:
    offered = request.headers.get("Accept-Encoding", "").split(",")
    return any(encoding.strip().lower() == "gzip" for encoding in offered)


def _without_token() -> web.Response:
    return _refused(401, "the token is missing or wrong: open the address that linkwright printed, token included")


def _refused(status: int, reason: str) -> web.Response:
    """Return an error response that closes its connection."""
    response = web.Response(status=status, text=f"{reason[0].upper()}{reason[1:]}.\n")
    response.force_close()
    return response


async def _file_response(
    request: web.Request, path: Path, content_type: str, cache: str, *, packs: bool
) -> web.Response:
    """Return a response with a file, or 304 if the browser already has this version of the file.

    The ETag changes with the content. With `packs`, the file is compressed if that makes it clearly smaller, and a
    header has the uncompressed length.

    aiohttp's own FileResponse is not used: it also looks for compressed files next to the requested one, which no check
    covers.
    """
    try:
        read = await asyncio.to_thread(_read, path, request.headers.get("If-None-Match", ""))
    except OSError:
        raise _no_file() from None
    headers = {"Cache-Control": cache, "ETag": read.tag, "Vary": "Accept-Encoding"}
    if read.body is None:
        return web.Response(status=304, headers=headers)
    headers["Content-Type"] = content_type
    body = read.body
    if packs and len(body) >= _LEAST_PACKED:
        packed = await asyncio.to_thread(gzip.compress, body, _PACKING_LEVEL, mtime=0)
        if len(packed) < _WORTH_PACKING * len(body):
            headers |= {"Content-Encoding": "gzip", "X-Unpacked-Length": str(len(body))}
            body = packed
    response = web.Response(body=body, headers=headers)
    response.last_modified = read.modified
    return response


def _attached(name: str) -> str:
    return f"attachment; filename*=UTF-8''{quote(name)}"


async def _stream_file(request: web.Request, path: Path) -> web.StreamResponse:
    """Send a file for download in blocks, so that only one block at a time is in memory."""
    try:
        file = await asyncio.to_thread(path.open, "rb")
    except OSError:
        raise _no_file() from None
    with file:
        response = web.StreamResponse(
            headers={"Content-Type": "application/octet-stream", "Content-Disposition": _attached(path.name)}
        )
        response.content_length = left = os.fstat(file.fileno()).st_size
        await response.prepare(request)
        while left and (block := await asyncio.to_thread(file.read, min(left, _BLOCK))):
            left -= len(block)
            await response.write(block)
    await response.write_eof()
    return response


def _no_file() -> web.HTTPNotFound:
    return web.HTTPNotFound(text="There is no such file.\n")


@dataclass(frozen=True, slots=True)
class _FileRead:
    """A version of a file: its ETag, its modification time (seconds), and its content."""

    tag: str
    modified: float
    body: bytes | None

    def is_known_to(self, request: web.Request) -> bool:
        """Return whether the browser already has this version."""
        return _is_among(self.tag, request.headers.get("If-None-Match", ""))


def _read(path: Path, known: str, *, unpack: bool = False) -> _FileRead:
    """Return the current version of a regular file, decompressed if `unpack` is set.

    The content is omitted if the ETag is in `known`, an If-None-Match header.
    """
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
        facts = os.fstat(descriptor)
        if not stat.S_ISREG(facts.st_mode):
            raise OSError("not a regular file")
        tag = f'"{facts.st_mtime_ns:x}-{facts.st_size:x}{"-unpacked" if unpack else ""}"'
        if _is_among(tag, known):
            return _FileRead(tag, facts.st_mtime, None)
        return _FileRead(tag, facts.st_mtime, gzip.decompress(file.read()) if unpack else file.read())


def _is_among(tag: str, known: str) -> bool:
    return tag in {entry.strip().removeprefix("W/") for entry in known.split(",")}


def listen(host: str, port: int | None) -> socket.socket:
    """Return a listening socket.

    Args:
        host: a name or address of this machine.
        port: 0 for any port; None for `DEFAULT_PORT`, or the next free one if that is in use.

    Raises:
        LinkwrightError: VIEW101, the requested port is in use; VIEW102, it is not possible to listen on the port;
            VIEW103, the host is unknown.
    """
    try:
        family, _, _, _, address = socket.getaddrinfo(host, 0, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, UnicodeError):
        hint = phrase("use 127.0.0.1, or 0.0.0.0 to accept connections from other machines")
        message = phrase("'{host}' is not a name or address of this machine", host=host)
        raise LinkwrightError(Diagnostic("VIEW103", message, hint=hint)) from None
    candidates = [port] if port is not None else [*range(DEFAULT_PORT, DEFAULT_PORT + _TRIES), 0]
    for candidate in candidates:
        try:
            return _listen_at(family, (address[0], candidate))
        except OSError as error:  # noqa: PERF203 - few ports, and each may be taken
            if candidate == candidates[-1] or error.errno != errno.EADDRINUSE:
                raise LinkwrightError(_cannot_listen(host, candidate, error)) from None
    raise AssertionError("the last port listens or raises")


def url_of(listener: socket.socket) -> str:
    """Return the URL at which a browser on this machine reaches a listening socket."""
    host, port = listener.getsockname()[:2]
    host = _WILDCARDS.get(host, host)
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


def is_open_to_others(listener: socket.socket) -> bool:
    """Return whether other machines can reach a listening socket."""
    return not ipaddress.ip_address(listener.getsockname()[0].partition("%")[0]).is_loopback


def _listen_at(family: int, address: tuple[str | int, int]) -> socket.socket:
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(64)  # detects a conflict: two programs may bind a port, but only one can listen
        listener.setblocking(False)
    except (OSError, OverflowError) as error:
        listener.close()
        if isinstance(error, OverflowError):
            raise OSError(errno.EINVAL, phrase("give a port from 0 to 65535")) from None
        raise
    return listener


def _cannot_listen(host: str, port: int, error: OSError) -> Diagnostic:
    if error.errno == errno.EADDRINUSE:
        hint = phrase("choose another port with '--port', or omit '--port' to use the next free one")
        return Diagnostic("VIEW101", phrase("port {port} of '{host}' is in use", port=port, host=host), hint=hint)
    return Diagnostic(
        "VIEW102",
        phrase(
            "cannot listen on port {port} of '{host}': {strerror}",
            port=port,
            host=host,
            strerror=foreign(error.strerror or error),
        ),
    )


def keep_short(transport: asyncio.Transport) -> None:
    """Limit the amount of unsent data in a connection's buffers, without limiting the data in flight.

    Buffered data can neither be replaced by newer data nor be overtaken. The operating system lets its send buffer grow
    to megabytes, which take many seconds on a slow connection. Where it offers no other limit (Windows), its buffer
    is left unchanged, and only the pages' acknowledgements limit the buffered data.
    """
    transport.set_write_buffer_limits(high=MOST_UNSENT)
    connection = transport.get_extra_info("socket")
    if connection is not None and _NOT_SENT_LOW_WATER is not None:
        connection.setsockopt(socket.IPPROTO_TCP, _NOT_SENT_LOW_WATER, MOST_UNSENT)
