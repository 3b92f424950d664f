"""UDP multicast without DDS, for commands that test whether the network supports it.

Group and port are those of ros2cli.
"""

from __future__ import annotations

import socket
import struct

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, foreign, phrase

GROUP = "225.0.0.1"
PORT = 49150
LARGEST = 4096
"""Bytes of a datagram that are read."""


def open_sender(ttl: int | None = None) -> socket.socket:
    """Open a socket for `send`.

    Args:
        ttl: how many hops a datagram may travel; None for the system's default of 1, which no router passes on.
    """
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    if ttl is not None:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
    return sender


def send(sender: socket.socket, data: bytes, group: str = GROUP, port: int = PORT) -> None:
    """Send a datagram.

    Raises:
        LinkwrightError: CLI461, the system refuses to send it.
    """
    try:
        sender.sendto(data, (group, port))
    except OSError as error:
        raise _refused(error, group, port) from error


def open_receiver(group: str = GROUP, port: int = PORT) -> socket.socket:
    """Open a socket that receives the datagrams of a group, even if other programs receive them too.

    Raises:
        LinkwrightError: CLI461, the system refuses to open it.
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
        raise _refused(error, group, port) from error
    return receiver


def _refused(error: OSError, group: str, port: int) -> LinkwrightError:
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
