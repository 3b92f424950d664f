"""Zenoh as ROS 2 nodes with rmw_zenoh_cpp use it. Importing this package does not load the library."""

from linkwright.wire.zenoh.joining import join, why_not
from linkwright.wire.zenoh.transport import ZenohTransport

__all__ = ["ZenohTransport", "join", "why_not"]
