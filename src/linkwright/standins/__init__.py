"""Stand-ins: modules with the names and interfaces of ROS 2 modules, for use where ROS 2 is not installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
