"""Access to the server: only with the token, under a name that is this machine's, and from its own pages.

The token is in the address that the program prints; the page keeps it in the browser's storage, which belongs to this
host and port alone, and sends it when it opens its WebSocket. There is no cookie: browsers send cookies to any server
on this machine, at any port, and for pages without the token. Names are checked because a
stranger's site can give its own name this machine's address (DNS rebinding) and would then be of one origin with us.
Connections that have not shown the token are limited in number and time.

A page whose program ended looks for it at the same port, where another user's program may listen by then. It shows the
token only to a server that proves to know it (`Gate.proof`).
"""

from __future__ import annotations

import asyncio
import hmac
import ipaddress
import re
import socket
from collections.abc import Callable, Mapping
from urllib.parse import urlsplit

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
        """Return the reason why a request is refused, whatever it asks for (403); None if it may pass."""
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
