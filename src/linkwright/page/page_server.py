"""The server of a viewer, which serves the page even before the viewer exists."""

from __future__ import annotations

import errno
import ipaddress
import os
import socket
from collections.abc import Mapping
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.page.access import PROGRAM_PAGES_VARIABLE, Gate, PortToken, create_token, load_token, store_pages_wait
from linkwright.page.files import Downloads, MeshFolders

if TYPE_CHECKING:
    from collections.abc import Callable

    from linkwright.page.audience import Audience
    from linkwright.page.program_pages import Embedding, ProgramPages
    from linkwright.page.server import WebServer
    from linkwright.page.uploads import Guests

DEFAULT_PORT = 7448
"""The port after 7447, on which Zenoh routers listen (decision 0066)."""

_PORT_COUNT = 10


class PageServer:
    """A server that listens at an address and checks the token of pages.

    Args:
        host: the address to listen on; any address except loopback admits other machines with the token.
        port: the port; 0 for any free port; None for 7448 or the next free port.
        only_loopback: whether an address that other machines can reach is refused, because pages have a terminal.
        needs_terminal: whether the command has no option for the terminal that could be left out.

    Attributes:
        host: the address that the server listens on.
        meshes: the folders that pages may read from.
        downloads: the files generated for pages.
        url: the address to open in a browser, including the token; empty before `open`.
        is_open_to_others: whether other machines can reach the server.
        web: the server that handles requests; None before `open`.
        program_pages: the pages of programs in terminals of the page; None if the page has no terminals.
    """

    def __init__(
        self, host: str, port: int | None, *, only_loopback: bool = False, needs_terminal: bool = False
    ) -> None:
        self.meshes = MeshFolders()
        self.downloads = Downloads()
        self.url = ""
        self.is_open_to_others = False
        self.web: WebServer | None = None
        self.host, self._port = host, port
        self._only_loopback = only_loopback
        self._needs_terminal = needs_terminal
        self._port_token: tuple[int, PortToken] | None = None
        self.program_pages = _create_program_pages() if only_loopback else None
        self._embedding: Embedding | None = None

    async def open(self) -> None:
        """Start listening, and serve the files of the page.

        Other requests wait for `show`.

        Raises:
            LinkwrightError: VIEW101 to VIEW103, the server cannot listen at the address; VIEW104, other machines could
                reach it.
        """
        from linkwright.page.server import WebServer

        listener = listen(self.host, self._port)
        self.is_open_to_others = is_open_to_others(listener)
        if self.is_open_to_others and self._only_loopback:
            listener.close()
            raise LinkwrightError(_make_open_to_others_warning(self.host, needs_terminal=self._needs_terminal))
        if self._port != 0 and not self.is_open_to_others:
            port = listener.getsockname()[1]
            self._port_token = port, load_token(port)
        gate = Gate(self.host, self._port_token[1].token if self._port_token else create_token())
        self.web = WebServer(gate, self.meshes, self.downloads, program_pages=self.program_pages)
        self.url = await self.web.start(listener)

    def show(self, audience: Audience, open_guests: Callable[[], Guests] | None) -> None:
        """Admit pages, see `WebServer.show`."""
        if self.web is not None:
            self.web.show(audience, open_guests)

    @property
    def is_embedded(self) -> bool:
        """Whether another page shows the page of this server in a frame.

        This program then runs in a terminal of the other page.
        """
        return self._embedding is not None

    def on_pause(self, function: Callable[[bool], bool]) -> None:
        """Call a function when the embedding page asks to pause or resume a world.

        See `Embedding`.
        """
        if self._embedding is not None:
            self._embedding.on_pause = function

    async def embed(self, environment: Mapping[str, str], title: str) -> bool:
        """Show the page in a frame of the page in whose terminal this program runs.

        Pages that have terminals, or that other machines can reach, are never shown in frames.

        Args:
            environment: the environment variables of this program.
            title: the title of the frame.

        Returns:
            Whether the page is shown there.
        """
        if PROGRAM_PAGES_VARIABLE not in environment:
            return False
        from linkwright.page.program_pages import Embedder  # few programs run in a terminal of a page

        embedder = Embedder.of(environment)
        if self.web is None or embedder is None or self.program_pages is not None or self.is_open_to_others:
            return False
        self.web.frame_ancestor = embedder.origin
        self._embedding = await embedder.show(self.url, title)
        if self._embedding is None and self.web is not None:
            self.web.frame_ancestor = None
        return self.is_embedded

    @property
    def pages_wait(self) -> bool:
        """Whether pages of the previous program at this port are waiting to reconnect."""
        return self._port_token is not None and self._port_token[1].pages_wait

    def store_pages_wait(self, *, pages_wait: bool) -> None:
        """Store whether pages wait for the next program.

        Call this before the program ends.
        """
        if self._port_token is not None:
            (port, port_token), self._port_token = self._port_token, None
            store_pages_wait(port, port_token.token, pages_wait=pages_wait)

    async def close(self) -> None:
        """Close the connections to pages and stop listening."""
        if self._embedding is not None:
            self._embedding.close()
            self._embedding = None
        web, self.web = self.web, None
        if web is not None:
            await web.close()


def listen(host: str, port: int | None) -> socket.socket:
    """Return a listening socket.

    Args:
        host: a name or address of this machine.
        port: the port; 0 for any free port; None for `DEFAULT_PORT` or the next free port.

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
    candidates = [port] if port is not None else [*range(DEFAULT_PORT, DEFAULT_PORT + _PORT_COUNT), 0]
    for candidate in candidates:
        try:
            return _listen_at(family, (address[0], candidate))
        except OSError as error:  # noqa: PERF203 - few ports, and each may be in use
            if candidate == candidates[-1] or error.errno != errno.EADDRINUSE:
                raise LinkwrightError(_cannot_listen_error(host, candidate, error)) from None
    raise AssertionError("the last port listens or raises")


def is_open_to_others(listener: socket.socket) -> bool:
    """Return whether other machines can reach a listening socket."""
    return not ipaddress.ip_address(listener.getsockname()[0].partition("%")[0]).is_loopback


def _listen_at(family: int, address: tuple[str | int, int]) -> socket.socket:
    listener = socket.socket(family, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(64)  # several programs may bind a port, but `listen` fails for all except one
        listener.setblocking(False)
    except (OSError, OverflowError) as error:
        listener.close()
        if isinstance(error, OverflowError):
            raise OSError(errno.EINVAL, phrase("the port must be from 0 to 65535")) from None
        raise
    return listener


def _cannot_listen_error(host: str, port: int, error: OSError) -> Diagnostic:
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


def _create_program_pages() -> ProgramPages:
    from linkwright.page.program_pages import ProgramPages  # most pages have no terminal

    return ProgramPages()


def _make_open_to_others_warning(host: str, *, needs_terminal: bool) -> Diagnostic:
    message = phrase("a page with a terminal cannot be served at '{host}', which other machines can reach", host=host)
    hint = phrase("leave out `--host`, and reach the page through an SSH tunnel; or leave out `--terminal`")
    if needs_terminal:
        hint = phrase("leave out `--host`, and reach the page through an SSH tunnel")
    return Diagnostic("VIEW104", message, hint=hint)
