"""Limits for connections that have not authenticated yet: how many there may be, and for how long."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

MAXIMUM_CONNECTIONS = 256
"""Open at once. A browser opens some six for a page."""

PATIENCE = 10.0
"""Seconds until a new connection must have made a request that is let in."""


class Admission:
    """Bounds the connections of a server.

    When there are as many as may be, a new one takes the place of the oldest that has not shown the token yet; where
    all have, it is refused. So neither connections left half open nor a thousand at once keep anybody out for long,
    and those that are let in notice nothing.

    Args:
        make: makes what serves a connection.
    """

    def __init__(self, make: Callable[[], asyncio.Protocol]) -> None:
        self._make = make
        self._strangers: dict[asyncio.Protocol, Entrance] = {}
        self._count = 0

    def __call__(self) -> asyncio.Protocol:
        """What serves the next connection."""
        return Entrance(self, self._make())

    def admit(self, served: object) -> None:
        """A request on a connection was let in; it may stay."""
        entrance = self._strangers.pop(served, None)  # type: ignore[call-overload]
        if entrance is not None:
            entrance.admitted()

    def opened(self, entrance: Entrance) -> bool:
        """Whether a new connection may stay for now."""
        if self._count >= MAXIMUM_CONNECTIONS:
            oldest = next(iter(self._strangers.values()), None)
            if oldest is None:
                return False
            oldest.end()
        self._count += 1
        self._strangers[entrance.served] = entrance
        return True

    def closed(self, entrance: Entrance) -> None:
        """A connection that `opened` let stay has ended."""
        self._count -= 1
        self._strangers.pop(entrance.served, None)


class Entrance(asyncio.Protocol):
    """Stands between a connection and what serves it."""

    def __init__(self, admission: Admission, served: asyncio.Protocol) -> None:
        self.served = served
        self._admission = admission
        self._transport: asyncio.BaseTransport | None = None
        self._counted = False
        self._deadline: asyncio.TimerHandle | None = None

    def admitted(self) -> None:
        """The connection may stay."""
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def end(self) -> None:
        """Cut the connection off, at once."""
        self.admitted()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        if isinstance(self._transport, asyncio.Transport):
            self._transport.abort()

    # --- asyncio.Protocol --------------------------------------------------------------------------------------

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Serve it, if it may stay."""
        self._transport = transport
        self._counted = self._admission.opened(self)
        self.served.connection_made(transport)
        if self._counted:
            self._deadline = asyncio.get_running_loop().call_later(PATIENCE, self.end)
        else:
            self.end()

    def connection_lost(self, exc: Exception | None) -> None:
        """It has ended."""
        self.admitted()
        if self._counted:
            self._counted = False
            self._admission.closed(self)
        self.served.connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Pass it on."""
        self.served.data_received(data)

    def eof_received(self) -> bool | None:
        """Pass it on."""
        return self.served.eof_received()

    def pause_writing(self) -> None:
        """Pass it on."""
        self.served.pause_writing()

    def resume_writing(self) -> None:
        """Pass it on."""
        self.served.resume_writing()
