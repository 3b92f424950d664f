"""Keep multicast announcements inside the machine, on Linux.

A time to live of 0 should have this effect. However, Linux drops such a packet only on an interface where the machine
itself is a member of the packet's group (``ip_mc_output``); on any other interface it sends the packet. The process
therefore joins the group on each of its interfaces, with its own address as the only source, so that packets of other
machines to the group are still refused.
"""

from __future__ import annotations

import socket
import struct
import sys
from collections.abc import Sequence

_MULTICAST_GROUP = "239.255.0.1"
"""The multicast group of the announcements in a domain (DDSI-RTPS 2.5, 9.6.1.4.1)."""

_ADD_SOURCE_MEMBERSHIP = 39
"""``IP_ADD_SOURCE_MEMBERSHIP`` of Linux, which Python's `socket` has from 3.12 on."""

_Membership = struct.Struct("4s4s4s")
"""``struct ip_mreq_source``: group, interface, source."""


def confine_announcements(addresses: Sequence[str]) -> socket.socket | None:
    """Keep announcements with a time to live of 0 inside the machine.

    Args:
        addresses: the IPv4 addresses of the interfaces other than loopback.

    Returns:
        A socket that must stay open while announcements are sent; None on systems that do not need one.

    Raises:
        OSError: the system refuses a membership, so announcements could leave the machine.
    """
    if not sys.platform.startswith("linux"):
        return None
    membership_socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        for address in addresses:
            packed_address = socket.inet_aton(address)
            membership = _Membership.pack(socket.inet_aton(_MULTICAST_GROUP), packed_address, packed_address)
            membership_socket.setsockopt(socket.IPPROTO_IP, _ADD_SOURCE_MEMBERSHIP, membership)
    except OSError:
        membership_socket.close()
        raise
    return membership_socket
