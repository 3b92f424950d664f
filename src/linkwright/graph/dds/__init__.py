"""The graph on the wire: DDS as real ROS 2 nodes speak it. Importing this does not load the DDS library."""

from linkwright.graph.dds.availability import available, why_not
from linkwright.graph.dds.joining import join
from linkwright.graph.dds.transport import DdsTransport

__all__ = ["DdsTransport", "available", "join", "why_not"]
