"""How many processes of this machine take part in a domain, as far as the system reports it: by their ports.

Every DDS implementation listens on the ports that RTPS gives to a domain (DDSI-RTPS 2.3, 9.6.1.1): one that all share
for multicast, one of its own for unicast, or both. So a process that has not answered yet is seen here already.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path

_PORT_BASE = 7400
_DOMAIN_GAIN = 250
_FIRST_UNICAST = 10
_TABLES = ("udp", "udp6")


def multicast_port(domain_id: int) -> int:
    """The port on which announcements to everybody in a domain arrive (SPDP_WELL_KNOWN_MULTICAST_PORT)."""
    return _PORT_BASE + _DOMAIN_GAIN * domain_id


def other_processes(domain_id: int, tables: Path = Path("/proc/self/net")) -> int | None:
    """At least how many other processes take part in a domain.

    No process listens twice on a port of the domain, so there are as many as listen on its multicast port, or on its
    unicast ports for announcements (every second one), whichever are more.

    Args:
        domain_id: the DDS domain.
        tables: the folder with the system's tables of sockets (proc(5)).

    Returns:
        The number, which may be 0; None where the system does not report it.
    """
    first = multicast_port(domain_id)
    listening: Counter[int] = Counter()
    try:
        own = _own_sockets()
        for name in _TABLES:
            for line in (tables / name).read_text().splitlines()[1:]:
                words = line.split()
                port = int(words[1].rpartition(":")[2], 16)
                if words[9] not in own:
                    listening[port] += 1
    except (OSError, ValueError, IndexError):
        return None
    unicast = range(first + _FIRST_UNICAST, first + _DOMAIN_GAIN, 2)
    return max(listening[first], sum(listening[port] for port in unicast))


def waiting_bytes(port: int, tables: Path = Path("/proc/self/net")) -> int | None:
    """How many bytes wait to be received at a UDP port of this machine, with the system's overhead of each packet.

    Args:
        port: the port; where several sockets listen on it, the fullest counts.
        tables: the folder with the system's tables of sockets (proc(5)).

    Returns:
        The bytes, 0 also where no socket listens; None where the system does not report them.
    """
    pattern = b":%04X" % port
    most = 0
    try:
        for line in (tables / _TABLES[0]).read_bytes().splitlines():
            if pattern in line:
                words = line.split()
                if words[1].endswith(pattern):
                    most = max(most, int(words[4].rpartition(b":")[2], 16))
    except (OSError, ValueError, IndexError):
        return None
    return most


def _own_sockets() -> set[str]:
    """The inodes of this process's sockets."""
    folder = Path("/proc/self/fd")
    found = set()
    for entry in folder.iterdir():
        try:
            target = str(entry.readlink())
        except OSError:  # closed since
            continue
        if target.startswith("socket:["):
            found.add(target[len("socket:[") : -1])
    return found
