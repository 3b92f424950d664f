"""UDP multicast without DDS, for commands that test whether the network supports multicast.

The default group and port are those of ros2cli.
"""

from __future__ import annotations

import socket
import struct

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, foreign, phrase

GROUP = "225.0.0.1"
PORT = 49150
MAX_DATAGRAM_BYTES = 4096
"""The maximum number of bytes of a datagram that are read."""


def open_sender(ttl: int | None = None) -> socket.socket:
    """Open a socket with which `send` can send datagrams.

    Args:
        ttl: the maximum number of hops of a datagram; None for the system's default of 1, which stops at routers.
    """
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    if ttl is not None:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
    return sender


def send(sender: socket.socket, data: bytes, group: str = GROUP, port: int = PORT) -> None:
    """Send a datagram.

    Raises:
        LinkwrightError: CLI461, the system refuses to send the datagram.
    """
    try:
        sender.sendto(data, (group, port))
    except OSError as error:
        raise _multicast_error(error, group, port) from error


def open_receiver(group: str = GROUP, port: int = PORT) -> socket.socket:
    """Open a socket that receives the datagrams of a group.

    Other programs may use the same group and port.

    Raises:
        LinkwrightError: CLI461, the system refuses to open the socket.
    """
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiver.bind(("", port))
        membership = struct.pack("=4sI", socket.inet_aton(group), socket.INADDR_ANY)
        receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError as error:
        receiver.close()
        raise _multicast_error(error, group, port) from error
    return receiver


def _multicast_error(error: OSError, group: str, port: int) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "CLI461",
            phrase("multicast to {group}:{port} is not possible here", group=group, port=port),
            notes=(Note(foreign(error.strerror or error)),),
            hint=phrase(
                "use a network interface with a multicast route, and a port that no other program uses exclusively"
            ),
        )
    )
