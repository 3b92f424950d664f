"""Stand-ins: modules with the names and interfaces of ROS 2 modules, for use without ROS 2."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
