"""Access to the server: only with the token, under a name that is this machine's, and from its own pages.

The token is in the address that the program prints; the page keeps it in the browser's storage, which belongs to this
host and port alone, and sends it when it opens its WebSocket. There is no cookie: browsers send cookies to any server
on this machine, at any port, and for pages without the token. Names are checked because a
stranger's site can give its own name this machine's address (DNS rebinding) and would then be of one origin with us.
Connections that have not shown the token are limited in number and time.

A page whose program ended looks for it at the same port, where another user's program may listen by then. It shows the
token only to a server that proves to know it (`Gate.proof`).

The token of a port, stored for the next start, so that open pages reconnect when the program is started again.

There is a file for each port, which only its user can read. A token is valid for a week after its creation, so that
a leaked one does not give access for ever. Servers that other machines can reach do not store theirs: it goes over
the network in plain text.
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
    """The token of a port.

    Attributes:
        token: the token that pages send.
        pages_wait: whether pages were open at the end of the former program, which now look for this one.
    """

    token: str
    pages_wait: bool = False


def token_folder() -> Path:
    """Return the folder of the files, below the user's state."""
    return state_folder() / "page-tokens"


def keep_token(port: int) -> PortToken:
    """Return the token of the user's last program on a port, or a new one, and store it."""
    now = time.time()
    made, stored = _read(token_folder() / str(port))
    if stored is None or not 0.0 <= now - made < _LIFETIME:
        made, stored = now, PortToken(new_token())
    _write(port, made, PortToken(stored.token))
    return stored


def leave_token(port: int, token: str, *, pages_wait: bool) -> None:
    """Store at the end of a program whether its pages wait for the next one, unless the file has another token."""
    made, stored = _read(token_folder() / str(port))
    if stored is not None and stored.token == token:
        _write(port, made, PortToken(token, pages_wait))


def _read(path: Path) -> tuple[float, PortToken | None]:
    """Return a token's creation time, seconds since the epoch, and the token; None unless the file is private."""
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
    """Return whether only this user can have read or written a file; Windows protects the user's folders itself."""
    if not stat.S_ISREG(facts.st_mode):
        return False
    user = getattr(os, "getuid", None)
    return user is None or (facts.st_uid == user() and not facts.st_mode & 0o077)


def _write(port: int, made: float, port_token: PortToken) -> None:
    """Store a token; if the state cannot be written, the next program has another, which is not an error."""
    folder = token_folder()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        content = {"token": port_token.token, "made": made, "pages wait": port_token.pages_wait}
        write_whole_file(folder / str(port), json.dumps(content), mode=0o600)


_NONCE = re.compile(r"[0-9a-f]{32}")
_PLAIN_HOST = re.compile(r"[A-Za-z0-9_.\-]+(:\d+)?|\[[0-9A-Fa-f:.]+\](:\d+)?")

TOKEN_PARAMETER = "token"  # noqa: S105 - the name of a query parameter


class Gate:
    """Checks requests.

    Args:
        host: the name that the server is bound to, which is allowed too.
        token: what opens the page.
    """

    def __init__(self, host: str, token: str) -> None:
        self.token = token
        machine = socket.gethostname().lower()
        self._names = {"localhost", host.lower(), machine, f"{machine}.local"}

    def refusal(self, headers: Mapping[str, str]) -> str | None:
        """Return the reason to refuse a request, whatever it asks for (403); None if it is accepted."""
        host = headers.get("Host", "")
        if not self.knows(host):
            return f"this server does not answer to the name '{host[:200]}': open the address that linkwright printed"
        origin = headers.get("Origin")
        if origin is not None and not _same(origin, host):
            return f"requests from pages of '{origin[:200]}' are refused"
        return None

    def is_shown_token(self, query: Mapping[str, str]) -> bool:
        """Return whether the query of a request has the token."""
        given = query.get(TOKEN_PARAMETER)
        return given is not None and hmac.compare_digest(given.encode(errors="replace"), self.token.encode())

    def proof(self, nonce: str) -> str | None:
        """Return the HMAC-SHA256 of a page's nonce (32 hexadecimal digits), which needs the token to compute.

        None for any other nonce. It reveals nothing about the token.
        """
        return hmac.digest(self.token.encode(), nonce.encode(), "sha256").hex() if _NONCE.fullmatch(nonce) else None

    def knows(self, host_header: str) -> bool:
        """Return whether a Host header names this machine: a bare address, localhost, or its own name."""
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
        return True  # an IP address is not looked up, so it cannot have been rebound


def _same(origin: str, host: str) -> bool:
    try:
        parts = urlsplit(origin)
    except ValueError:
        return False
    return parts.scheme in ("http", "https") and parts.netloc.lower() == host.lower()


def security_headers(host: str) -> dict[str, str]:
    """Return headers for every answer.

    Scripts come from files of ours only. They may evaluate text: ours never do, but browser automation waits for a
    condition on ``window.linkwright`` that way, and without inline scripts there is no text of a stranger's to
    evaluate. Styles may stand inline, which the dock and the property grid need; images and workers may also be made
    by the page itself.
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
    """Limits the connections of a server.

    When the limit is reached, a new one replaces the oldest that has neither shown the token yet nor named a file that
    only its holders know; if all have, it is refused. So neither half-open connections nor a thousand at once block
    others for long, and admitted connections are not affected.

    Args:
        make: returns the protocol of a connection.
    """

    def __init__(self, make: Callable[[], asyncio.Protocol]) -> None:
        self._make = make
        self._strangers: dict[asyncio.Protocol, Entrance] = {}
        self._count = 0

    def __call__(self) -> asyncio.Protocol:
        """Return the protocol for the next connection."""
        return Entrance(self, self._make())

    def asked(self, served: object) -> None:
        """Keep a connection that made a request until its place is needed, however slow its line is."""
        entrance = self._strangers.get(served)  # type: ignore[call-overload]
        if entrance is not None:
            entrance.may_stay()

    def admit(self, served: object) -> None:
        """Keep a connection that has shown the token."""
        entrance = self._strangers.pop(served, None)  # type: ignore[call-overload]
        if entrance is not None:
            entrance.may_stay()

    def opened(self, entrance: Entrance) -> bool:
        """Return whether a new connection may stay for now."""
        if self._count >= MAXIMUM_CONNECTIONS:
            oldest = next(iter(self._strangers.values()), None)
            if oldest is None:
                return False
            oldest.end()
        self._count += 1
        self._strangers[entrance.served] = entrance
        return True

    def closed(self, entrance: Entrance) -> None:
        """Release the place of a connection."""
        self._count -= 1
        self._strangers.pop(entrance.served, None)


_PASSED_ON = ("data_received", "eof_received", "pause_writing", "resume_writing")


class Entrance(asyncio.Protocol):
    """Counts and bounds a connection at its beginning and end; its data goes directly to the protocol behind it."""

    def __init__(self, admission: Admission, served: asyncio.Protocol) -> None:
        self.served = served
        self._admission = admission
        self._transport: asyncio.BaseTransport | None = None
        self._counted = False
        self._deadline: asyncio.TimerHandle | None = None
        for name in _PASSED_ON:  # in place of methods that would only forward
            setattr(self, name, getattr(served, name))

    def may_stay(self) -> None:
        """Cancel the deadline for the first request."""
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def end(self) -> None:
        """Abort the connection."""
        self.may_stay()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        if isinstance(self._transport, asyncio.Transport):
            self._transport.abort()

    # --- asyncio.Protocol --------------------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Serve the connection, if it may stay."""
        self._transport = transport
        self._counted = self._admission.opened(self)
        self.served.connection_made(transport)
        if self._counted:
            self._deadline = asyncio.get_running_loop().call_later(PATIENCE, self.end)
        else:
            self.end()

    def connection_lost(self, exc: Exception | None) -> None:
        """Release the connection's place."""
        self.may_stay()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        self.served.connection_lost(exc)
