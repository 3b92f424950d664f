"""Modules with the names and interfaces of ROS 2 modules that are not installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
