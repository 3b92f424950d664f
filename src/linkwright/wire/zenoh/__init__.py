"""Zenoh as used by ROS 2 nodes with rmw_zenoh_cpp.

Importing this package does not load the Zenoh library.
"""

from linkwright.wire.zenoh.joining import join, unavailable_reason
from linkwright.wire.zenoh.transport import ZenohTransport

__all__ = ["ZenohTransport", "join", "unavailable_reason"]
