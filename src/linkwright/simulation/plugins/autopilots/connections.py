"""Connections to an autopilot that does not wait for the simulation: TCP, at which it connects, and UDP."""

from __future__ import annotations

import select
import socket
from contextlib import suppress

_BUFFER_SIZE = 1 << 16


class TcpConnection:
    """A TCP server for one autopilot; a new connection replaces a closed one.

    Args:
        address: the address and the port at which it listens.

    Attributes:
        address: the address and the port; the port is the one that the system chose for port 0.
        peer: the address of the connected autopilot, or None.

    Raises:
        OSError: the address cannot be used.
        OverflowError: the port is not valid.
    """

    def __init__(self, address: tuple[str, int]) -> None:
        self._server = socket.create_server(address)
        self._server.setblocking(False)
        self._client: socket.socket | None = None
        self.address: tuple[str, int] = self._server.getsockname()
        self.peer: tuple[str, int] | None = None

    def receive(self, timeout: float) -> bytes:
        """Return the bytes that have arrived, after at most a timeout in s; empty if there are none."""
        if self._client is None:
            with suppress(OSError):
                self._client, self.peer = self._server.accept()
                self._client.setblocking(False)
                self._client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if self._client is None:
            return b""
        if timeout > 0.0:
            select.select([self._client], [], [], timeout)
        try:
            data = self._client.recv(_BUFFER_SIZE)
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._disconnect()
        return data

    def send(self, data: bytes) -> None:
        """Send bytes to the autopilot; an autopilot that does not read them is disconnected."""
        if self._client is None:
            return
        try:
            sent = self._client.send(data)
        except OSError:
            sent = 0
        if sent < len(data):
            self._disconnect()

    def close(self) -> None:
        """Close the connection and the server."""
        self._disconnect()
        self._server.close()

    def _disconnect(self) -> None:
        if self._client is not None:
            self._client.close()
        self._client = self.peer = None


class UdpConnection:
    """A UDP socket that sends to an autopilot, and later to where its newest packet is from.

    Args:
        remote: the address and the port of the autopilot.

    Attributes:
        peer: the address of the autopilot.

    Raises:
        OSError: the socket cannot be created.
    """

    def __init__(self, remote: tuple[str, int]) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self.peer: tuple[str, int] | None = remote

    def receive(self, timeout: float) -> bytes:
        """Return the bytes that have arrived, after at most a timeout in s; empty if there are none."""
        if timeout > 0.0:
            select.select([self._socket], [], [], timeout)
        data = b""
        with suppress(OSError):  # no more packets, or the autopilot has ended
            while True:
                packet, self.peer = self._socket.recvfrom(_BUFFER_SIZE)
                data += packet
        return data

    def send(self, data: bytes) -> None:
        """Send a packet to the autopilot."""
        if self.peer is not None:
            with suppress(OSError, OverflowError):  # the autopilot may have ended
                self._socket.sendto(data, self.peer)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()
