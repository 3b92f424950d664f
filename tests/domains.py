"""ROS domains that no other process on this machine uses.

Other processes are those of other checkouts, or other workers of a parallel run.
"""

from __future__ import annotations

import functools
import random
import socket

_LAST_DOMAIN = 100
"""The last domain. From 101 on, the ports of a domain are in Linux's range of ephemeral ports."""
_FIRST_PORT = 27_000

_locks: list[socket.socket] = []
"""The sockets that reserve domains; they stay open until the process ends."""


@functools.cache
def own_domain(which: int = 0) -> int:
    """Return a ROS_DOMAIN_ID for this process and its child processes.

    It is reserved by listening on a port of its number, which only one process at a time can do.

    Args:
        which: distinguishes several domains of a test.
    """
    domains = list(range(1, _LAST_DOMAIN + 1))
    random.SystemRandom().shuffle(domains)
    for number in domains:
        lock = socket.socket()
        try:
            lock.bind(("127.0.0.1", _FIRST_PORT + number))
            lock.listen()
        except OSError:
            lock.close()
            continue
        _locks.append(lock)
        return number
    raise RuntimeError("other test runs use all ROS domains")
