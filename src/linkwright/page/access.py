"""Access control for the server: the token, the host name and the origin of requests.

The token is in the address that the program prints. The page keeps it in the browser's storage, which belongs to this
host and port alone, and sends it when it opens its WebSocket. There is no cookie, because browsers send cookies to any
server on this machine, at any port, and also for pages that do not have the token. Host names are checked because a
foreign site can point its own name to this machine's address (DNS rebinding), and would then have the same origin as
the server. Connections that have not sent the token are limited in number and time.

A page whose program has ended tries to reconnect at the same port, where another user's program may be listening by
then. The page sends the token only to a server that proves that it knows the token (`Gate.proof`).

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
from urllib.parse import urlsplit

from linkwright.files.user_folders import state_folder
from linkwright.files.whole_files import write_whole_file

_LIFETIME = 7 * 24 * 3600.0
"""Seconds."""

_TOKEN = re.compile(r"[\w-]{32}")
_LONGEST = 1000
"""Most bytes of such a file."""


def new_token() -> str:
    """Return a random token of 192 bits."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class PortToken:
    """The token of a port, as stored for the next program at that port.

    Attributes:
        token: the token that pages send.
        pages_wait: whether pages were open when the former program ended, which now try to reconnect.
    """

    token: str
    pages_wait: bool = False


def token_folder() -> Path:
    """Return the folder of the token files, below the user's state folder."""
    return state_folder() / "page-tokens"


def keep_token(port: int) -> PortToken:
    """Return the stored token of a port, or a new token if there is no valid one, and store it.

    The returned `pages_wait` is that of the former program; it is reset in the file.
    """
    now = time.time()
    made, stored = _read(token_folder() / str(port))
    if stored is None or not 0.0 <= now - made < _LIFETIME:
        made, stored = now, PortToken(new_token())
    _write(port, made, PortToken(stored.token))
    return stored


def leave_token(port: int, token: str, *, pages_wait: bool) -> None:
    """Store whether the pages of an ending program wait for the next program at the port.

    Nothing is stored if the file contains another token.
    """
    made, stored = _read(token_folder() / str(port))
    if stored is not None and stored.token == token:
        _write(port, made, PortToken(token, pages_wait))


def _read(path: Path) -> tuple[float, PortToken | None]:
    """Return a token's creation time in seconds since the epoch, and the token.

    The token is None if the file cannot be read, is not private, or has no valid content.
    """
    with suppress(OSError, ValueError, TypeError, KeyError, RecursionError):
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
        with open(descriptor, "rb") as file:  # noqa: PTH123 - a descriptor, not a path
            if _is_private(os.fstat(descriptor)):
                stored = json.loads(file.read(_LONGEST))
                made, token = float(stored["made"]), str(stored["token"])
                if _TOKEN.fullmatch(token):
                    return made, PortToken(token, stored.get("pages wait") is True)
    return 0.0, None


def _is_private(facts: os.stat_result) -> bool:
    """Return whether only this user can read and write a regular file.

    On Windows, which protects the user's folders itself, only the kind of file is checked.
    """
    if not stat.S_ISREG(facts.st_mode):
        return False
    user = getattr(os, "getuid", None)
    return user is None or (facts.st_uid == user() and not facts.st_mode & 0o077)


def _write(port: int, made: float, port_token: PortToken) -> None:
    """Store a token; failures are ignored, and the next program then has another token."""
    folder = token_folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        content = {"token": port_token.token, "made": made, "pages wait": port_token.pages_wait}
        write_whole_file(folder / str(port), json.dumps(content), mode=0o600)


_NONCE = re.compile(r"[0-9a-f]{32}")
_PLAIN_HOST = re.compile(r"[A-Za-z0-9_.\-]+(:\d+)?|\[[0-9A-Fa-f:.]+\](:\d+)?")

TOKEN_PARAMETER = "token"  # noqa: S105 - the name of a query parameter


class Gate:
    """Checks whether requests may access the server.

    Args:
        host: the name that the server is bound to, which is also accepted as a host name.
        token: the token that opens the page.
    """

    def __init__(self, host: str, token: str) -> None:
        self.token = token
        machine = socket.gethostname().lower()
        self._names = {"localhost", host.lower(), machine, f"{machine}.local"}

    def refusal(self, headers: Mapping[str, str]) -> str | None:
        """Return the reason why a request is refused because of its Host or Origin header (403), or None."""
        host = headers.get("Host", "")
        if not self.knows(host):
            return f"this server does not answer to the name '{host[:200]}': open the address that linkwright printed"
        origin = headers.get("Origin")
        if origin is not None and not _same(origin, host):
            return f"requests from pages of '{origin[:200]}' are refused"
        return None

    def is_shown_token(self, query: Mapping[str, str]) -> bool:
        """Return whether the query of a request contains the token."""
        given = query.get(TOKEN_PARAMETER)
        return given is not None and hmac.compare_digest(given.encode(errors="replace"), self.token.encode())

    def proof(self, nonce: str) -> str | None:
        """Return the HMAC-SHA256 of a page's nonce under the token, or None if the nonce is not valid.

        A nonce has 32 hexadecimal digits. The result proves that the server knows the token, but does not reveal it.
        """
        return hmac.digest(self.token.encode(), nonce.encode(), "sha256").hex() if _NONCE.fullmatch(nonce) else None

    def knows(self, host_header: str) -> bool:
        """Return whether a Host header names this machine: an IP address, localhost, or its own name."""
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


def _same(origin: str, host: str) -> bool:
    try:
        parts = urlsplit(origin)
    except ValueError:
        return False
    return parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()


def security_headers(host: str) -> dict[str, str]:
    """Return the security headers for every response.

    Scripts are loaded only from the server's files. They may evaluate text: the page's scripts never do, but browser
    automation evaluates a condition on ``window.linkwright`` to wait for it, and without inline scripts there is no
    foreign text to evaluate. Inline styles are allowed because the dock and the property grid need them. Images and
    workers may also be created by the page itself.
    """
    policy = {
        "default-src": "'none'",
        "script-src": "'self' 'unsafe-eval'",
        "style-src": "'self' 'unsafe-inline'",
        "img-src": "'self' data: blob:",
        "font-src": "'self' data:",
        "connect-src": f"'self' ws://{host} wss://{host} data: blob:",
        "worker-src": "'self' blob:",
        "manifest-src": "'self'",
        "base-uri": "'none'",
        "form-action": "'none'",
        "frame-ancestors": "'none'",
    }
    return {
        "Content-Security-Policy": "; ".join(f"{name} {value}" for name, value in policy.items()),
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Referrer-Policy": "no-referrer",
        "Server": "linkwright",
        "X-Content-Type-Options": "nosniff",
    }


MAXIMUM_CONNECTIONS = 256
"""Most open connections. A browser opens some six for a page."""

PATIENCE = 10.0
"""Seconds in which a new connection must make a request."""


class Admission:
    """Limits the number of connections to a server.

    When the limit is reached, a new connection replaces the oldest one that has neither sent the token nor requested a
    file whose address only token holders know. If all connections have done so, the new one is refused. Half-open
    connections, or a thousand simultaneous ones, can therefore not block others for long, and admitted connections are
    not affected.

    Args:
        make: returns a new protocol, which serves one connection.
    """

    def __init__(self, make: Callable[[], asyncio.Protocol]) -> None:
        self._make = make
        self._strangers: dict[asyncio.Protocol, Entrance] = {}
        self._count = 0

    def __call__(self) -> asyncio.Protocol:
        """Return the protocol for the next connection."""
        return Entrance(self, self._make())

    def asked(self, served: object) -> None:
        """Record that a connection has sent a request, so that it is closed only if its slot is needed."""
        entrance = self._strangers.get(served)  # type: ignore[call-overload]
        if entrance is not None:
            entrance.cancel_deadline()

    def admit(self, served: object) -> None:
        """Record that a connection has sent the token, so that no other connection replaces it."""
        entrance = self._strangers.pop(served, None)  # type: ignore[call-overload]
        if entrance is not None:
            entrance.cancel_deadline()

    def opened(self, entrance: Entrance) -> bool:
        """Count a new connection, and return False if it must be refused."""
        if self._count >= MAXIMUM_CONNECTIONS:
            oldest = next(iter(self._strangers.values()), None)
            if oldest is None:
                return False
            oldest.end()
        self._count += 1
        self._strangers[entrance.served] = entrance
        return True

    def closed(self, entrance: Entrance) -> None:
        """Release the slot of a connection."""
        self._count -= 1
        self._strangers.pop(entrance.served, None)


_PASSED_ON = ("data_received", "eof_received", "pause_writing", "resume_writing")


class Entrance(asyncio.Protocol):
    """The outer protocol of a connection, which counts and limits the connection.

    Received data goes directly to the inner protocol.
    """

    def __init__(self, admission: Admission, served: asyncio.Protocol) -> None:
        self.served = served
        self._admission = admission
        self._transport: asyncio.BaseTransport | None = None
        self._counted = False
        self._deadline: asyncio.TimerHandle | None = None
        for name in _PASSED_ON:  # saves a call for each event
            setattr(self, name, getattr(served, name))

    def cancel_deadline(self) -> None:
        """Cancel the deadline for the connection's first request."""
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def end(self) -> None:
        """Abort the connection."""
        self.cancel_deadline()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        if isinstance(self._transport, asyncio.Transport):
            self._transport.abort()

    # --- asyncio.Protocol --------------------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Serve the connection, or abort it if it must be refused."""
        self._transport = transport
        self._counted = self._admission.opened(self)
        self.served.connection_made(transport)
        if self._counted:
            self._deadline = asyncio.get_running_loop().call_later(PATIENCE, self.end)
        else:
            self.end()

    def connection_lost(self, exc: Exception | None) -> None:
        """Release the slot of the connection."""
        self.cancel_deadline()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        self.served.connection_lost(exc)
