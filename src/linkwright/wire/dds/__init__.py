"""DDS as ROS 2 nodes use it.

Importing this package does not load the DDS library.
"""

from linkwright.wire.dds.joining import is_available, join, unavailable_reason
from linkwright.wire.dds.transport import DdsTransport

__all__ = ["DdsTransport", "is_available", "join", "unavailable_reason"]
