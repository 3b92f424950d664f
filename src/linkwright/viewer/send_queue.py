"""Short queues in front of the network: what waits there can neither be replaced by newer data nor overtaken."""

from __future__ import annotations

import asyncio
import socket

MOST_UNSENT = 16 * 1024
"""Bytes that may wait in the program, and again as many in the operating system, before the writer has to."""

_NOT_SENT_LOW_WATER: int | None = getattr(socket, "TCP_NOTSENT_LOWAT", None)


def keep_short(transport: asyncio.Transport) -> None:
    """Let little wait in front of a connection, without bounding what is on its way.

    The system grows its send buffer to megabytes; over a slow line these are many seconds. Where it offers no other
    bound (Windows), its buffer stays as it is, and pages' acknowledgements alone keep the line free.
    """
    transport.set_write_buffer_limits(high=MOST_UNSENT)
    connection = transport.get_extra_info("socket")
    if connection is not None and _NOT_SENT_LOW_WATER is not None:
        connection.setsockopt(socket.IPPROTO_TCP, _NOT_SENT_LOW_WATER, MOST_UNSENT)
