"""UDP multicast without DDS, for commands that test whether the network supports multicast.

The default group and port are those of ros2cli.
"""

from __future__ import annotations

import socket
import struct

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, foreign, phrase

DEFAULT_GROUP = "225.0.0.1"
DEFAULT_PORT = 49150
MAX_DATAGRAM_BYTES = 4096
"""The maximum number of bytes of a datagram that are read."""


def open_sender(ttl: int | None = None) -> socket.socket:
    """Open a socket with which `send` can send datagrams.

    Args:
        ttl: the maximum number of hops of a datagram; None for the system's default of 1, which stops at routers.
    """
    sending_socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    if ttl is not None:
        sending_socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
    return sending_socket


def send(sending_socket: socket.socket, data: bytes, group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT) -> None:
    """Send a datagram.

    Raises:
        LinkwrightError: CLI461, the system refuses to send the datagram.
    """
    try:
        sending_socket.sendto(data, (group, port))
    except OSError as error:
        raise _multicast_error(error, group, port) from error


def open_receiver(group: str = DEFAULT_GROUP, port: int = DEFAULT_PORT) -> socket.socket:
    """Open a socket that receives the datagrams of a group.

    Other programs may use the same group and port.

    Raises:
        LinkwrightError: CLI461, the system refuses to open the socket.
    """
    receiving_socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        receiving_socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "SO_REUSEPORT"):
            receiving_socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        receiving_socket.bind(("", port))
        membership = struct.pack("=4sI", socket.inet_aton(group), socket.INADDR_ANY)
        receiving_socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    except OSError as error:
        receiving_socket.close()
        raise _multicast_error(error, group, port) from error
    return receiving_socket


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
