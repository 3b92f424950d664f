"""ROS domains that no other process on this machine uses.

Other processes are those of other checkouts, other workers of a parallel run, and checks of lessons.
"""

from __future__ import annotations

import functools
import random

from linkwright.learning.checks.domains import lock_domain

_LAST_DOMAIN = 100
"""The last domain. From 101 on, the ports of a domain are in Linux's range of ephemeral ports."""


@functools.cache
def own_domain(which: int = 0) -> int:
    """Return a ROS_DOMAIN_ID for this process and its child processes.

    It is reserved in the same way as the domains of checks.

    Args:
        which: distinguishes several domains of a test.
    """
    domains = list(range(1, _LAST_DOMAIN + 1))
    random.SystemRandom().shuffle(domains)
    for number in domains:
        if lock_domain(number):
            return number
    raise RuntimeError("other test runs use all ROS domains")
