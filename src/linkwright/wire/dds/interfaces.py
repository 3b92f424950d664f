"""The addresses of this machine beside loopback.

Cyclone complains aloud when it is told of an interface that is not there, and a process that was told to stay on the
machine may be met at the address of its interface alone.
"""

from __future__ import annotations

import socket
import struct
import sys

_SIOCGIFADDR = 0x8915
_REQUEST = "256s"


def own_addresses() -> list[str]:
    """The IPv4 addresses of the interfaces beside loopback, in the system's order."""
    addresses = _by_interface() if sys.platform.startswith("linux") else _by_name()
    return [address for address in dict.fromkeys(addresses) if address and not address.startswith("127.")]


def _by_interface() -> list[str]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asking:
        return [_address(asking, name) for _, name in socket.if_nameindex()]


def _address(asking: socket.socket, name: str) -> str:
    """The address of an interface; empty when it has none."""
    from fcntl import ioctl

    try:
        answer = ioctl(asking.fileno(), _SIOCGIFADDR, struct.pack(_REQUEST, name.encode()[:15]))
    except OSError:
        return ""
    return socket.inet_ntoa(answer[20:24])


def _by_name() -> list[str]:
    try:
        found = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        return []
    return [str(address[0]) for *_, address in found]
