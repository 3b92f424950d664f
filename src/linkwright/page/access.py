"""Access control for the server: the token, the host name and the origin of requests.

The address that the program prints contains the token. The page stores the token in the browser's storage for this
host and port, and sends it when it opens its WebSocket. Cookies are not used, because browsers send them to
every server on this machine at any port, even for pages without the token. Host names are checked because a
foreign site can point its name to the address of this machine (DNS rebinding). Its pages would then have the same
origin as the server. Connections that have not sent the token are limited in number and time.

When the program ends, its pages try to reconnect at the same port, where the program of another user may be
listening. The page sends the token only to a server that proves that it has the token (`Gate.proof`).

The token of a port is stored for the next start, so that open pages can reconnect when the program is started again.
There is a file for each port, which only its user can read. A token is valid for a week after its creation, which
limits the damage of a leaked token. Servers that other machines can reach do not store their tokens, because such
tokens are sent over the network in plain text.
"""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
import json
import os
import re
import secrets
import socket
import stat
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias
from urllib.parse import urlsplit

from linkwright.files.user_folders import state_folder
from linkwright.files.whole_files import write_whole_file

if TYPE_CHECKING:
    from asyncio import BaseTransport

IPAddress: TypeAlias = ipaddress.IPv4Address | ipaddress.IPv6Address
Endpoint: TypeAlias = tuple[IPAddress, int]
"""An address and a TCP port."""

PROGRAM_PAGES_VARIABLE = "LINKWRIGHT_PROGRAM_PAGES"
"""The environment variable with the address to which programs in a terminal of the page send their page's address."""

PROGRAM_PAGES_PATH = "/programs/"
"""The path of this address."""

_TOKEN_LIFETIME_S = 7 * 24 * 3600.0
"""The time for which a stored token is valid, in seconds."""

_TOKEN = re.compile(r"[\w-]{32}")
_MAX_FILE_SIZE = 1000
"""The largest number of bytes that are read from a token file."""


def create_token() -> str:
    """Return a random token of 192 bits."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class PortToken:
    """The token of a port, as stored for the next program at that port.

    Attributes:
        token: the token that pages send.
        pages_wait: whether pages that were open when the previous program ended now try to reconnect.
    """

    token: str
    pages_wait: bool = False


def get_token_folder() -> Path:
    """Return the folder of the token files, below the user's state folder."""
    return state_folder() / "page-tokens"


def load_token(port: int) -> PortToken:
    """Return the stored token of a port.

    If there is no valid one, create and store a new token. The result contains the `pages_wait` of the previous
    program, which is reset in the file.
    """
    now = time.time()
    created, stored = _read(get_token_folder() / str(port))
    if stored is None or not 0.0 <= now - created < _TOKEN_LIFETIME_S:
        created, stored = now, PortToken(create_token())
    _write(port, created, PortToken(stored.token))
    return stored


def store_pages_wait(port: int, token: str, *, pages_wait: bool) -> None:
    """Store whether the pages of a program that ends wait for the next program at the port.

    Nothing is stored if the file contains another token.
    """
    created, stored = _read(get_token_folder() / str(port))
    if stored is not None and stored.token == token:
        _write(port, created, PortToken(token, pages_wait))


def _read(path: Path) -> tuple[float, PortToken | None]:
    """Return the creation time of a stored token in seconds since the epoch, and the token.

    The token is None if the file cannot be read, is not private, or has no valid content.
    """
    with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
            if _is_private(os.fstat(descriptor)):
                stored = json.loads(file.read(_MAX_FILE_SIZE))
                created, token = float(stored["made"]), str(stored["token"])
                if _TOKEN.fullmatch(token):
                    return created, PortToken(token, stored.get("pages wait") is True)
    return 0.0, None


def _is_private(status: os.stat_result) -> bool:
    """Return whether a file is regular and only this user can read and write it.

    On Windows, which protects the folders of users, only the kind of the file is checked.
    """
    if not stat.S_ISREG(status.st_mode):
        return False
    user = getattr(os, "getuid", None)
    return user is None or (status.st_uid == user() and not status.st_mode & 0o077)


def _write(port: int, created: float, port_token: PortToken) -> None:
    """Store a token.

    A failure is ignored. The next program then gets a new token.
    """
    folder = get_token_folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        content = {"token": port_token.token, "made": created, "pages wait": port_token.pages_wait}
        write_whole_file(folder / str(port), json.dumps(content), mode=0o600)


_NONCE = re.compile(r"[0-9a-f]{32}")
_PLAIN_HOST = re.compile(r"[A-Za-z0-9_.\-]+(:\d+)?|\[[0-9A-Fa-f:.]+\](:\d+)?")

TOKEN_PARAMETER = "token"  # noqa: S105 - the name of a query parameter


class Gate:
    """The check whether requests may access the server.

    Args:
        host: the name that the server is bound to, which is also accepted as a host name.
        token: the token that opens the page.
    """

    def __init__(self, host: str, token: str) -> None:
        self.token = token
        machine = socket.gethostname().lower()
        self._names = {"localhost", host.lower(), machine, f"{machine}.local"}

    def find_refusal_reason(self, headers: Mapping[str, str]) -> str | None:
        """Return why a request is refused (403) for its Host or Origin header, or None."""
        host = headers.get("Host", "")
        if not self.accepts_host(host):
            return f"this server does not answer to the name '{host[:200]}': open the address that linkwright printed"
        origin = headers.get("Origin")
        if origin is not None and not _is_same_origin(origin, host):
            return f"requests from pages of '{origin[:200]}' are refused"
        return None

    def has_token(self, query: Mapping[str, str]) -> bool:
        """Return whether the query of a request contains the token."""
        query_token = query.get(TOKEN_PARAMETER)
        return query_token is not None and hmac.compare_digest(
            query_token.encode(errors="replace"), self.token.encode()
        )

    def proof(self, nonce: str) -> str | None:
        """Return the HMAC-SHA256 of a page's nonce under the token, or None for an invalid nonce.

        A nonce has 32 hexadecimal digits. The result proves that the server has the token, but does not reveal it.
        """
        return hmac.digest(self.token.encode(), nonce.encode(), "sha256").hex() if _NONCE.fullmatch(nonce) else None

    def accepts_host(self, host_header: str) -> bool:
        """Return whether a Host header is an IP address, localhost, or a name of this machine."""
        if not _PLAIN_HOST.fullmatch(host_header):
            return False
        try:
            name = urlsplit(f"//{host_header}").hostname or ""
        except ValueError:
            return False
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return name.removesuffix(".") in self._names
        return True  # DNS rebinding is impossible with an IP address


def _is_same_origin(origin: str, host: str) -> bool:
    try:
        url = urlsplit(origin)
    except ValueError:
        return False
    return url.scheme in ("http", "https") and url.netloc.lower() == host.lower()


def make_security_headers(host: str, *, frames: str = "'none'", frame_ancestors: str = "'none'") -> dict[str, str]:
    """Return the security headers for every response.

    Scripts are loaded only from the server's files. They may evaluate text, because browser automation does so to wait
    for a condition on ``window.linkwright``. The scripts of the page never do, and no foreign text can reach them
    without inline scripts. Inline styles are allowed because the dock and the property grid need them. The page may
    also create images and workers.

    Args:
        host: the Host header of the request.
        frames: the pages that the page may show in frames, as a source list of a content security policy.
        frame_ancestors: the origins whose pages may show the page in a frame, as a source list.
    """
    policy = {
        "default-src": "'none'",
        "script-src": "'self' 'unsafe-eval'",
        "style-src": "'self' 'unsafe-inline'",
        "img-src": "'self' data: blob:",
        "font-src": "'self' data:",
        "connect-src": f"'self' ws://{host} wss://{host} data: blob:",
        "worker-src": "'self' blob:",
        "frame-src": frames,
        "manifest-src": "'self'",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": frame_ancestors,
    }
    return {
        "Content-Security-Policy": "; ".join(f"{name} {value}" for name, value in policy.items()),
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Referrer-Policy": "no-referrer",
        "Server": "linkwright",
        "X-Content-Type-Options": "nosniff",
    }


MAX_CONNECTIONS = 256
"""The largest number of open connections. A browser opens about six for a page."""

FIRST_REQUEST_TIMEOUT_S = 10.0
"""Seconds within which a new connection must send a request."""


class Admission:
    """The limit on the number of connections to a server.

    A connection is admitted when it has sent the token, or requested a file with a secret address. When the limit is
    reached, a new connection replaces the oldest connection that is not admitted. If all connections are admitted, the
    new connection is refused. Half-open connections can therefore not block others for long.

    Args:
        make_protocol: returns a new protocol for one connection.
    """

    def __init__(self, make_protocol: Callable[[], asyncio.Protocol]) -> None:
        self._make_protocol = make_protocol
        self._unadmitted_connections: dict[asyncio.Protocol, LimitedConnection] = {}
        self._count = 0

    def __call__(self) -> asyncio.Protocol:
        """Return the protocol for the next connection."""
        return LimitedConnection(self, self._make_protocol())

    def request_received(self, inner_protocol: object) -> None:
        """Record that a connection has sent a request in time.

        It is then closed only if its slot is needed.
        """
        connection = self._unadmitted_connections.get(inner_protocol)  # type: ignore[call-overload]
        if connection is not None:
            connection.cancel_deadline()

    def admit(self, inner_protocol: object) -> None:
        """Record that a connection has sent the token. No other connection replaces it."""
        connection = self._unadmitted_connections.pop(inner_protocol, None)  # type: ignore[call-overload]
        if connection is not None:
            connection.cancel_deadline()

    def try_open(self, connection: LimitedConnection) -> bool:
        """Count a new connection, or return False to refuse it.

        At the limit, the oldest connection that is not admitted is closed to make room.
        """
        if self._count >= MAX_CONNECTIONS:
            oldest = next(iter(self._unadmitted_connections.values()), None)
            if oldest is None:
                return False
            oldest.end()
        self._count += 1
        self._unadmitted_connections[connection.served] = connection
        return True

    def release(self, connection: LimitedConnection) -> None:
        """Release the slot of a connection."""
        self._count -= 1
        self._unadmitted_connections.pop(connection.served, None)


_FORWARDED_EVENTS = ("data_received", "eof_received", "pause_writing", "resume_writing")


class LimitedConnection(asyncio.Protocol):
    """The outer protocol of a connection, which counts and limits the connection.

    Received data goes directly to the inner protocol.
    """

    def __init__(self, admission: Admission, inner_protocol: asyncio.Protocol) -> None:
        self.served = inner_protocol
        self._admission = admission
        self._transport: asyncio.BaseTransport | None = None
        self._is_counted = False
        self._deadline: asyncio.TimerHandle | None = None
        for name in _FORWARDED_EVENTS:  # direct attributes save a call for each event
            setattr(self, name, getattr(inner_protocol, name))

    def cancel_deadline(self) -> None:
        """Cancel the deadline for the connection's first request."""
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def end(self) -> None:
        """Abort the connection."""
        self.cancel_deadline()
        if self._is_counted:
            self._is_counted = False
            self._admission.release(self)
        if isinstance(self._transport, asyncio.Transport):
            self._transport.abort()

    # --- asyncio.Protocol --------------------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Serve the connection, or abort it if it must be refused."""
        self._transport = transport
        self._is_counted = self._admission.try_open(self)
        self.served.connection_made(transport)
        if self._is_counted:
            self._deadline = asyncio.get_running_loop().call_later(FIRST_REQUEST_TIMEOUT_S, self.end)
        else:
            self.end()

    def connection_lost(self, exc: Exception | None) -> None:
        """Release the slot of the connection."""
        self.cancel_deadline()
        if self._is_counted:
            self._is_counted = False
            self._admission.release(self)
        self.served.connection_lost(exc)


def is_local_connection(transport: BaseTransport | None) -> bool:
    """Return whether a connection comes from this machine.

    It then comes over loopback, or from an address of this machine.
    """
    endpoints = find_endpoints(transport)
    if endpoints is None:
        return False
    (peer, _), (own_address, _) = endpoints
    return peer.is_loopback or peer == own_address


def find_endpoints(transport: BaseTransport | None) -> tuple[Endpoint, Endpoint] | None:
    """Return the addresses and ports of the peer and of this program, or None if unknown."""
    if transport is None:
        return None
    peer, own_address = (transport.get_extra_info(name) for name in ("peername", "sockname"))
    return (_endpoint(peer), _endpoint(own_address)) if peer and own_address else None


def _endpoint(name: tuple[str, int]) -> Endpoint:
    address = ipaddress.ip_address(name[0].partition("%")[0])
    return getattr(address, "ipv4_mapped", None) or address, name[1]
