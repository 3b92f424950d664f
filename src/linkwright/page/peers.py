"""The user as whom the peer of a connection from this machine runs.

Linux lists the TCP sockets of all users, with their owners, in tables below ``/proc/net`` (`proc_pid_net(5)`). Other
systems have no such list that every user can read.
"""

from __future__ import annotations

import ipaddress
import os
import sys
from asyncio import BaseTransport
from pathlib import Path

from linkwright.page.access import Endpoint, find_endpoints

_TABLES = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))

_MAX_READS = 3
"""The number of times that the tables are read. The system may omit a socket while others open and close."""

_ESTABLISHED = "01"
_USER_FIELD, _INODE_FIELD = 3, 5  # counted from the field after the state
_ROOT = 0


def may_be_own_user(transport: BaseTransport | None) -> bool:
    """Return whether the peer of a local connection may run as this user, or as root.

    On Linux, the system knows the user. Root is accepted because root can do everything that this user can, and
    because the relay that connects a browser on Windows to WSL is expected to run as root.

    Returns:
        True if the system does not list the sockets of other users. False if the socket is not listed as open, because
        a socket that its program has closed has no owner.
    """
    endpoints = find_endpoints(transport)
    if endpoints is None:
        return False
    if not sys.platform.startswith("linux"):
        return True
    for _ in range(_MAX_READS):
        tables = _read_tables()
        if not tables:
            return True
        user = _find_socket_user(tables, *endpoints)
        if user is not None:
            return user in (os.geteuid(), _ROOT)
    return False


def _read_tables() -> str:
    """Return the tables of TCP sockets, or an empty text if they cannot be read."""
    return "".join(map(_read_table, _TABLES))


def _read_table(table: Path) -> str:
    try:
        return table.read_text("ascii")
    except OSError:
        return ""  # tcp6 is missing without IPv6, and a sandbox may hide both


def _find_socket_user(tables: str, local: Endpoint, remote: Endpoint) -> int | None:
    """Return the ID of the user who owns an open socket with these addresses, or None.

    A socket that its program has closed has no inode, and the user 0 in the tables.
    """
    for write in (_to_table_address, _to_mapped_table_address):  # an IPv6 socket can connect to an IPv4 address
        start = f" {write(local)} {write(remote)} {_ESTABLISHED} "
        position = tables.find(start)
        if position >= 0:
            fields = tables[position + len(start) :].split(maxsplit=_INODE_FIELD + 1)
            return int(fields[_USER_FIELD]) if fields[_INODE_FIELD] != "0" else None
    return None


def _to_table_address(endpoint: Endpoint) -> str:
    """Return an address and port in the form of the tables.

    The tables contain 32-bit words in the byte order of the machine.
    """
    address, port = endpoint
    packed = address.packed
    words = (int.from_bytes(packed[start : start + 4], sys.byteorder) for start in range(0, len(packed), 4))
    return f"{''.join(f'{word:08X}' for word in words)}:{port:04X}"


def _to_mapped_table_address(endpoint: Endpoint) -> str:
    address, port = endpoint
    if isinstance(address, ipaddress.IPv4Address):
        address = ipaddress.IPv6Address(f"::ffff:{address}")
    return _to_table_address((address, port))
