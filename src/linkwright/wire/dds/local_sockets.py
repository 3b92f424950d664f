"""Count the processes of this machine in a domain, by the ports that the system reports.

Every DDS implementation listens on the ports that RTPS assigns to a domain (DDSI-RTPS 2.3, 9.6.1.1): one shared port
for multicast, one separate port for unicast, or both. This way a process is counted even before it has answered.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

_PORT_BASE = 7400
_DOMAIN_GAIN = 250
_FIRST_UNICAST = 10
_TABLE_NAMES = ("udp", "udp6")


def compute_multicast_port(domain_id: int) -> int:
    """Return the port for a domain's announcements (SPDP_WELL_KNOWN_MULTICAST_PORT)."""
    return _PORT_BASE + _DOMAIN_GAIN * domain_id


def count_other_processes(domain_id: int, tables: Path = Path("/proc/self/net")) -> int | None:
    """Return a lower bound of the number of other processes that take part in a domain.

    No process listens twice on a port of the domain. The number is therefore the number of sockets on the domain's
    multicast port or on its unicast ports for announcements (every second port), whichever is greater.

    Args:
        domain_id: the DDS domain.
        tables: the folder with the system's tables of sockets (proc(5)).

    Returns:
        The number, which may be 0; None if the system does not report sockets.
    """
    base_port = compute_multicast_port(domain_id)
    socket_counts: Counter[int] = Counter()
    try:
        own_sockets = _find_own_sockets()
        for name in _TABLE_NAMES:
            for line in (tables / name).read_text().splitlines()[1:]:
                fields = line.split()
                port = int(fields[1].rpartition(":")[2], 16)
                if fields[9] not in own_sockets:
                    socket_counts[port] += 1
    except (OSError, ValueError, IndexError):
        return None
    unicast_ports = range(base_port + _FIRST_UNICAST, base_port + _DOMAIN_GAIN, 2)
    return max(socket_counts[base_port], sum(socket_counts[port] for port in unicast_ports))


def count_waiting_bytes(port: int, tables: Path = Path("/proc/self/net")) -> int | None:
    """Return the number of bytes waiting at a UDP port of this machine.

    The number includes the system's overhead per packet.

    Args:
        port: the port; if several sockets listen on it, the socket with the most bytes counts.
        tables: the folder with the system's tables of sockets (proc(5)).

    Returns:
        The number of bytes, 0 if no socket listens; None if the system does not report sockets.
    """
    pattern = b":%04X" % port
    max_bytes = 0
    try:
        for line in (tables / _TABLE_NAMES[0]).read_bytes().splitlines():
            if pattern in line:
                fields = line.split()
                if fields[1].endswith(pattern):
                    max_bytes = max(max_bytes, int(fields[4].rpartition(b":")[2], 16))
    except (OSError, ValueError, IndexError):
        return None
    return max_bytes


def _find_own_sockets() -> set[str]:
    """Return the inodes of this process's sockets."""
    folder = Path("/proc/self/fd")
    inodes = set()
    for entry in folder.iterdir():
        try:
            target = str(entry.readlink())
        except OSError:  # the file was closed in the meantime
            continue
        if target.startswith("socket:["):
            inodes.add(target[len("socket:[") : -1])
    return inodes
