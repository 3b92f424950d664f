"""DDS, as ROS 2 nodes speak it. Importing this does not load the DDS library."""

from linkwright.wire.dds.joining import available, join, why_not
from linkwright.wire.dds.transport import DdsTransport

__all__ = ["DdsTransport", "available", "join", "why_not"]
