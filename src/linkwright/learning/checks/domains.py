"""Reserve a ROS domain that no other check uses."""

from __future__ import annotations

import os
import socket
import time

_DOMAINS = range(1, 101)
"""The domains among which checks select, without 0, the default. Other programs use the ports of higher ones."""

_FIRST_PORT = 7400
_PORTS_PER_DOMAIN = 250

_WAIT_S = 0.2


def reserve_domain() -> int:
    """Reserve a ROS domain for this process until the process ends, and return its ID.

    The domain of the environment is never returned, because the learner's own programs use it.

    Listening on a TCP port, which only one process can do, reserves the domain. The port is the first of those that DDS
    uses in the domain, over UDP. Ports have the same scope as domains, also in containers. If all domains are
    reserved, the function waits.
    """
    domains = [domain for domain in _DOMAINS if str(domain) != os.environ.get("ROS_DOMAIN_ID")]
    start = os.getpid() % len(domains)
    while True:
        for domain in domains[start:] + domains[:start]:
            if lock_domain(domain):
                return domain
        time.sleep(_WAIT_S)


def lock_domain(domain: int) -> bool:
    """Reserve a domain until the process ends, however it ends, and return whether no other process has reserved it."""
    lock = socket.socket()
    try:
        lock.bind(("127.0.0.1", _FIRST_PORT + _PORTS_PER_DOMAIN * domain))
        lock.listen()
    except OSError:
        lock.close()
        return False
    lock.detach()  # the descriptor stays open
    return True
