"""The web server: the page, its WebSocket, and its files."""

from __future__ import annotations

import asyncio
import gzip
import os
import re
import socket
import stat
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, cast
from urllib.parse import quote

from linkwright.page.access import (
    PROGRAM_PAGES_PATH,
    TOKEN_PARAMETER,
    Admission,
    Gate,
    is_local_connection,
    make_security_headers,
)
from linkwright.page.files import CONTENT_TYPES, IMAGE_TYPES, Downloads, FileRefusedError, MeshFolders
from linkwright.page.http_server import SERVER_LOGGER, web
from linkwright.page.peers import may_be_own_user

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping

    from linkwright.page.audience import Audience
    from linkwright.page.program_pages import ProgramPages
    from linkwright.page.uploads import Guests, Uploads

PAGE_FOLDER = Path(__file__).parent / "built"
"""The folder into which ``frontend/`` is built."""

MAX_MESSAGE_SIZE = 1024 * 1024
"""The maximum size in bytes of a message from a page. A longer message closes the page's socket (1009)."""

_OWN_CONFIGURATION_KEY = re.compile(r"[0-9A-Za-z-]{8,64}")
_HEARTBEAT_PERIOD_S = 15.0
_IDLE_TIMEOUT_S = 30.0
"""Seconds for which a connection may stay open without a request."""

_FRAME_SOURCES = "http://127.0.0.1:* http://localhost:*"
"""The pages that a page with a terminal may show in frames, as a source list of a content security policy."""

_LOOPBACK_OF_WILDCARD = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # noqa: S104 - not bound here, only replaced in URLs

_BACKLOG = 128
_BLOCK_SIZE = 256 * 1024
"""The number of bytes of a large file that are read at once."""

_MIN_COMPRESSED_SIZE, _MAX_COMPRESSION_RATIO, _COMPRESSION_LEVEL = 4096, 0.9, 1
"""The minimum size of a mesh to compress, the ratio below which the result is sent, and the level of gzip. The next
levels take twice the time and save another tenth."""

_NO_STORE = "no-store"
_CLOSE_TIMEOUT_S = 0.5
"""Seconds for a page to answer a closing handshake, and for a request to end."""

_NOT_BUILT = """\
The page of this viewer has not been built.

In a checkout of Linkwright run

    make page

and reload. If Linkwright was installed from a wheel, the wheel was built without the page.
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

MAX_UNSENT_BYTES = 16 * 1024
"""The maximum number of unsent bytes, in the program and again in the operating system, before writers wait."""

_NOT_SENT_LOW_WATER: int | None = getattr(socket, "TCP_NOTSENT_LOWAT", None)


@dataclass(slots=True)
class _Services:
    """The services for pages: the audience for their WebSockets, and the guests.

    The guests show recordings that pages upload. `guests` and `uploads` are created when the first upload is requested.
    """

    audience: Audience
    open_guests: Callable[[], Guests] | None
    guests: Guests | None = None
    uploads: Uploads | None = None


class WebServer:
    """The web server of a viewer.

    The files of the page are served even before the viewer exists.

    Args:
        gate: checks requests.
        meshes: the folders that pages may read from.
        downloads: files that were generated for pages.
        page_folder: the folder of the built page.
        program_pages: the pages of programs, which the page shows in frames; None to show none.

    Attributes:
        frame_ancestor: the origin whose pages may show the page in a frame; None for no page.
    """

    def __init__(
        self,
        gate: Gate,
        meshes: MeshFolders,
        downloads: Downloads,
        page_folder: Path = PAGE_FOLDER,
        program_pages: ProgramPages | None = None,
    ) -> None:
        self.frame_ancestor: str | None = None
        self._program_pages = program_pages
        self._gate = gate
        self._meshes = meshes
        self._downloads = downloads
        self._page_folder = page_folder
        self._services: asyncio.Future[_Services] = asyncio.get_running_loop().create_future()
        self._runner: web.AppRunner | None = None
        self._server: asyncio.Server | None = None
        self._admission: Admission | None = None
        self._page_contents: dict[tuple[Path, bool], _FileVersion] = {}
        self._read_lock = asyncio.Lock()

    async def start(self, listener: socket.socket) -> str:
        """Serve on a listening socket, and return the address to open, including the token.

        If this fails, the socket is closed.
        """
        application = web.Application(middlewares=[self._check_access])
        application.on_response_prepare.append(self._add_headers)
        application.router.add_get("/", self._serve_index)
        application.router.add_get("/proof", self._serve_proof, allow_head=False)
        application.router.add_get("/ws", self._serve_socket, allow_head=False)
        application.router.add_get("/mesh/{key}/{path:.+}", self._serve_mesh)
        application.router.add_get("/export/{key}/{name}", self._serve_export, allow_head=False)
        for method, path, handle_upload in _UPLOADS:
            application.router.add_route(method, path, self._require_token(partial(self._handle_upload, handle_upload)))
        application.router.add_post(
            "/export/{key}/{name}", self._require_token(partial(self._handle_upload, self._show_own_recording))
        )
        if self._program_pages is not None:
            application.router.add_post(
                f"{PROGRAM_PAGES_PATH}{{key}}", partial(self._show_program, self._program_pages)
            )
        application.router.add_get("/{path:.+}", self._serve_page_file)
        self._runner = web.AppRunner(
            application,
            handle_signals=False,
            access_log=None,
            logger=SERVER_LOGGER,
            shutdown_timeout=_CLOSE_TIMEOUT_S,
            keepalive_timeout=_IDLE_TIMEOUT_S,
        )
        try:
            await self._runner.setup()
            loop = asyncio.get_running_loop()
            self._admission = Admission(cast("web.Server", self._runner.server))
            self._server = await loop.create_server(
                self._admission, sock=listener, backlog=_BACKLOG, start_serving=False
            )
            await self._server.start_serving()
        except BaseException:
            try:
                await self.close()
            finally:
                listener.close()
            raise
        return f"{make_url(listener)}?{TOKEN_PARAMETER}={self._gate.token}"

    def show(self, audience: Audience, open_guests: Callable[[], Guests] | None = None) -> None:
        """Admit pages, including pages that are already waiting.

        Args:
            audience: serves the WebSockets of pages.
            open_guests: returns the guests, which show the recordings that pages upload; None to accept no uploads.
        """
        self._services.set_result(_Services(audience, open_guests))

    async def close(self) -> None:
        """Close the connections to pages, and stop serving."""
        if self._server is not None:
            self._server.close()
            self._server = None
        if self._program_pages is not None:
            self._program_pages.close()
        if not self._services.done():
            self._services.cancel()
        elif not self._services.cancelled():
            services = self._services.result()
            await services.audience.close()
            if services.uploads is not None:
                services.uploads.close()
        if self._runner is not None:
            await self._runner.cleanup()
            self._runner = None

    # --- access control ----------------------------------------------------------------------------------------

    @web.middleware
    async def _check_access(
        self, request: web.Request, handler: Callable[[web.Request], Awaitable[web.StreamResponse]]
    ) -> web.StreamResponse:
        if self._admission is not None:
            self._admission.request_received(request.protocol)
        reason = self._gate.find_refusal_reason(request.headers)
        if reason is not None:
            return _make_refusal(403, reason)
        if self._gate.has_token(request.query):
            self._admit(request)
        return await handler(request)

    def _admit(self, request: web.Request) -> None:
        if self._admission is not None:
            self._admission.admit(request.protocol)

    async def _add_headers(self, request: web.Request, response: web.StreamResponse) -> None:
        host = request.host if self._gate.accepts_host(request.host) else "localhost"
        frames = "'none'" if self._program_pages is None else _FRAME_SOURCES
        response.headers.update(
            make_security_headers(host, frames=frames, frame_ancestors=self.frame_ancestor or "'none'")
        )
        response.headers.setdefault("Cache-Control", _NO_STORE)

    # --- handlers of requests ----------------------------------------------------------------------------------

    async def _serve_index(self, request: web.Request) -> web.StreamResponse:
        index = self._page_folder / "index.html"
        if not index.is_file():
            return web.Response(status=503, text=_NOT_BUILT)
        # Browsers may apply a stored security policy to an unchanged page, and different programs use the same port.
        is_stored = self._program_pages is None and self.frame_ancestor is None
        return await self._send_page_file(request, index, _PAGE_TYPES[".html"], "no-cache" if is_stored else _NO_STORE)

    async def _serve_proof(self, request: web.Request) -> web.Response:
        """Prove to a page that this program also has the token. See `Gate.proof`."""
        proof = self._gate.proof(request.query.get("nonce", ""))
        if proof is None:
            return web.Response(status=400, text="This address is for the page only.\n")
        return web.Response(text=proof)

    async def _serve_page_file(self, request: web.Request) -> web.StreamResponse:
        path = request.match_info["path"]
        parts = path.split("/")
        content_type = _PAGE_TYPES.get(Path(parts[-1]).suffix)
        if content_type is None or any(part in ("", ".", "..") or "\0" in part or "\\" in part for part in parts):
            raise web.HTTPNotFound(text="There is no such page.\n")
        is_hashed = parts[0] == "assets"  # the names of assets contain a hash of their content
        cache = "private, max-age=31536000, immutable" if is_hashed else "no-cache"
        file = self._page_folder / path
        gzip_path = file.with_name(f"{file.name}.gz")
        if not (is_hashed and gzip_path.is_file()):
            return await self._send_page_file(request, file, content_type, cache)
        if not _accepts_gzip(request):
            vary = {"Vary": "Accept-Encoding"}
            return await self._send_page_file(request, gzip_path, content_type, cache, vary, decompress=True)
        # Compression reduces the files to a quarter, which saves tens of seconds on a slow connection.
        encoding_headers = {"Content-Encoding": "gzip", "Vary": "Accept-Encoding"}
        return await self._send_page_file(request, gzip_path, content_type, cache, encoding_headers)

    async def _send_page_file(
        self,
        request: web.Request,
        path: Path,
        content_type: str,
        cache: str,
        encoding_headers: Mapping[str, str] | None = None,
        *,
        decompress: bool = False,
    ) -> web.StreamResponse:
        """Send a file of the page, with one copy in memory for concurrent requests."""
        async with self._read_lock:
            cached = self._page_contents.get((path, decompress))
            try:
                file_version = await asyncio.to_thread(_read, path, cached.tag if cached else "", decompress=decompress)
            except OSError:
                raise _make_not_found_error() from None
            if cached is None or file_version.body is not None:
                cached = self._page_contents[path, decompress] = file_version
        headers = {"Cache-Control": cache, **(encoding_headers or {})}
        if cache != _NO_STORE:
            headers["ETag"] = cached.tag
        if cached.body is None or (cache != _NO_STORE and cached.is_known_to(request)):
            return web.Response(status=304, headers=headers)
        response = web.StreamResponse(headers={**headers, "Content-Type": content_type})
        response.content_length = len(cached.body)
        await response.prepare(request)
        if request.method != "HEAD":
            content = memoryview(cached.body)
            for start in range(0, len(content), MAX_UNSENT_BYTES):
                await response.write(content[start : start + MAX_UNSENT_BYTES])
        await response.write_eof()
        return response

    async def _serve_mesh(self, request: web.Request) -> web.StreamResponse:
        key, relative = request.match_info["key"], request.match_info["path"]
        try:
            path = await asyncio.to_thread(self._meshes.file, key, relative)
        except FileRefusedError as error:
            return web.Response(status=error.status, text=f"Refused: {error}.\n")
        self._admit(request)
        content_type = CONTENT_TYPES[path.suffix.lower()]
        # images are already compressed
        may_compress = _accepts_gzip(request) and path.suffix.lower() not in IMAGE_TYPES
        return await _make_file_response(request, path, content_type, "private, no-cache", may_compress=may_compress)

    async def _serve_export(self, request: web.Request) -> web.StreamResponse:
        file = self._downloads.withdraw(request.match_info["key"])
        recording = self._downloads.path(request.match_info["key"])
        if recording is not None:
            self._admit(request)
            return await _stream_file(request, recording)
        if file is None:
            raise web.HTTPNotFound(text="There is no such file; it can be fetched once.\n")
        self._admit(request)
        return web.Response(
            body=file.data,
            headers={"Content-Type": file.content_type, "Content-Disposition": _make_attachment_header(file.name)},
        )

    async def _handle_upload(
        self, handle_upload: Callable[[Uploads, web.Request], Awaitable[web.Response]], request: web.Request
    ) -> web.Response:
        services = await self._wait_for_services()
        if services.open_guests is None:
            raise web.HTTPNotFound(text="This program does not accept recordings.\n")
        if services.uploads is None:
            from linkwright.page.uploads import Uploads

            services.guests = services.open_guests()
            services.uploads = Uploads(services.guests)
        return await handle_upload(services.uploads, request)

    async def _wait_for_services(self) -> _Services:
        """Wait until the services for pages are available, and return them."""
        try:
            return await asyncio.shield(self._services)
        except asyncio.CancelledError:
            if not self._services.cancelled():
                raise  # the client has disconnected
            raise web.HTTPServiceUnavailable(text="The program is shutting down.\n") from None

    async def _show_own_recording(self, uploads: Uploads, request: web.Request) -> web.Response:
        """Show a recording that this program made, without an upload."""
        recording = self._downloads.path(request.match_info["key"])
        if recording is None:
            raise web.HTTPNotFound(text="There is no such recording.\n")
        return await uploads.show(request, recording)

    async def _show_program(self, programs: ProgramPages, request: web.Request) -> web.StreamResponse:
        if not programs.is_key(request.match_info["key"]):
            return _make_unauthorized_response()
        self._admit(request)
        return await programs.receive(request)

    def _require_token(
        self, handler: Callable[[web.Request], Awaitable[web.Response]]
    ) -> Callable[[web.Request], Awaitable[web.StreamResponse]]:
        """Return a handler that calls the given handler only for requests with the token."""

        async def check_token(request: web.Request) -> web.StreamResponse:
            return await handler(request) if self._gate.has_token(request.query) else _make_unauthorized_response()

        return check_token

    async def _serve_socket(self, request: web.Request) -> web.StreamResponse:
        if not self._gate.has_token(request.query):
            return _make_unauthorized_response()
        services = await self._wait_for_services()
        from linkwright.page.audience import Page, find_requested_language

        audience = _find_audience(services, request)
        if audience.is_full:
            return web.Response(status=503, text="Too many pages are open.\n")
        socket = web.WebSocketResponse(
            heartbeat=_HEARTBEAT_PERIOD_S,
            timeout=_CLOSE_TIMEOUT_S,
            compress=False,
            max_msg_size=MAX_MESSAGE_SIZE,
            writer_limit=MAX_UNSENT_BYTES,
        )
        if not socket.can_prepare(request):
            return web.Response(status=400, text="This address is for the page's WebSocket.\n")
        with audience.expecting():
            await socket.prepare(request)
        if request.transport is not None:
            limit_buffers(request.transport)
        page = Page(
            socket,
            _find_own_configuration(request),
            is_local=is_local_connection(request.transport),
            may_be_own_user=cache(partial(may_be_own_user, request.transport)),
            language=find_requested_language(request),
            origin=request.headers.get("Origin") or f"http://{request.host}",
        )
        await audience.attend(page, socket)
        return socket


_UPLOADS: tuple[tuple[str, str, Callable[[Uploads, web.Request], Awaitable[web.Response]]], ...] = (
    ("POST", "/recordings", lambda uploads, request: uploads.announce(request)),
    ("PUT", "/recordings/{key}/{number:[0-9]{1,4}}", lambda uploads, request: uploads.receive(request)),
    ("POST", "/recordings/{key}", lambda uploads, request: uploads.open(request)),
    ("DELETE", "/recordings/{key}", lambda uploads, request: uploads.cancel_upload(request)),
)
"""The methods, addresses and handlers of the requests with which pages upload recordings."""


def _find_audience(services: _Services, request: web.Request) -> Audience:
    """Return the audience of the recording that a request names, if it is still shown.

    Otherwise, return the audience of the viewer.
    """
    key = request.query.get("recording", "")
    audience = None if services.guests is None or not key else services.guests.audience(key)
    return services.audience if audience is None else audience


def _find_own_configuration(request: web.Request) -> str:
    """Return the name of the page's own configuration, or an empty string for the shared one."""
    key = request.query.get("own", "")
    return key if _OWN_CONFIGURATION_KEY.fullmatch(key) else ""


def _accepts_gzip(request: web.Request) -> bool:
    encodings = request.headers.get("Accept-Encoding", "").split(",")
    return any(encoding.strip().lower() == "gzip" for encoding in encodings)


def _make_unauthorized_response() -> web.Response:
    return _make_refusal(401, "the token is missing or wrong: open the address that linkwright printed, token included")


def _make_refusal(status: int, reason: str) -> web.Response:
    """Return an error response that closes its connection."""
    response = web.Response(status=status, text=f"{reason[0].upper()}{reason[1:]}.\n")
    response.force_close()
    return response


async def _make_file_response(
    request: web.Request, path: Path, content_type: str, cache: str, *, may_compress: bool
) -> web.Response:
    """Return a response with a file, or 304 if the browser already has this version.

    The ETag changes with the content. If `may_compress` is true and the file becomes clearly smaller, it is compressed,
    and a header contains the uncompressed length.

    FileResponse of aiohttp is not used, because it also looks for compressed files next to the requested file. These
    files would not be checked.
    """
    try:
        file_version = await asyncio.to_thread(_read, path, request.headers.get("If-None-Match", ""))
    except OSError:
        raise _make_not_found_error() from None
    headers = {"Cache-Control": cache, "ETag": file_version.tag, "Vary": "Accept-Encoding"}
    if file_version.body is None:
        return web.Response(status=304, headers=headers)
    headers["Content-Type"] = content_type
    body = file_version.body
    if may_compress and len(body) >= _MIN_COMPRESSED_SIZE:
        compressed_body = await asyncio.to_thread(gzip.compress, body, _COMPRESSION_LEVEL, mtime=0)
        if len(compressed_body) < _MAX_COMPRESSION_RATIO * len(body):
            headers |= {"Content-Encoding": "gzip", "X-Unpacked-Length": str(len(body))}
            body = compressed_body
    response = web.Response(body=body, headers=headers)
    response.last_modified = file_version.modified
    return response


def _make_attachment_header(name: str) -> str:
    return f"attachment; filename*=UTF-8''{quote(name)}"


async def _stream_file(request: web.Request, path: Path) -> web.StreamResponse:
    """Send a file for download in blocks, so that only one block at a time is in memory."""
    try:
        file = await asyncio.to_thread(path.open, "rb")
    except OSError:
        raise _make_not_found_error() from None
    with file:
        response = web.StreamResponse(
            headers={
                "Content-Type": "application/octet-stream",
                "Content-Disposition": _make_attachment_header(path.name),
            }
        )
        response.content_length = remaining_bytes = os.fstat(file.fileno()).st_size
        await response.prepare(request)
        while remaining_bytes and (block := await asyncio.to_thread(file.read, min(remaining_bytes, _BLOCK_SIZE))):
            remaining_bytes -= len(block)
            await response.write(block)
    await response.write_eof()
    return response


def _make_not_found_error() -> web.HTTPNotFound:
    return web.HTTPNotFound(text="There is no such file.\n")


@dataclass(frozen=True, slots=True)
class _FileVersion:
    """A version of a file: its ETag, its modification time (seconds), and its content."""

    tag: str
    modified: float
    body: bytes | None

    def is_known_to(self, request: web.Request) -> bool:
        """Return whether the browser already has this version."""
        return _matches_tag(self.tag, request.headers.get("If-None-Match", ""))


def _read(path: Path, known_tags: str, *, decompress: bool = False) -> _FileVersion:
    """Return the current version of a regular file, decompressed if `decompress` is true.

    The content is omitted if the ETag is in `known_tags`, an If-None-Match header.
    """
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise OSError("not a regular file")
        tag = f'"{status.st_mtime_ns:x}-{status.st_size:x}{"-unpacked" if decompress else ""}"'
        if _matches_tag(tag, known_tags):
            return _FileVersion(tag, status.st_mtime, None)
        return _FileVersion(tag, status.st_mtime, gzip.decompress(file.read()) if decompress else file.read())


def _matches_tag(tag: str, known_tags: str) -> bool:
    return tag in {entry.strip().removeprefix("W/") for entry in known_tags.split(",")}


def limit_buffers(transport: asyncio.Transport) -> None:
    """Limit the unsent data in a connection's buffers, but not the data in flight.

    Buffered data can be neither replaced by newer data nor overtaken. The send buffer of the operating system can grow
    to megabytes, which take many seconds on a slow connection. On Windows, which does not offer this limit, only the
    acknowledgments of pages limit the buffered data.
    """
    transport.set_write_buffer_limits(high=MAX_UNSENT_BYTES)
    connection = transport.get_extra_info("socket")
    if connection is not None and _NOT_SENT_LOW_WATER is not None:
        connection.setsockopt(socket.IPPROTO_TCP, _NOT_SENT_LOW_WATER, MAX_UNSENT_BYTES)


def make_url(listener: socket.socket) -> str:
    """Return the URL with which a browser on this machine reaches a listening socket."""
    host, port = listener.getsockname()[:2]
    host = _LOOPBACK_OF_WILDCARD.get(host, host)
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"
