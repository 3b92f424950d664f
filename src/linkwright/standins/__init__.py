"""Modules that have the names and interfaces of ROS 2 modules, which need not be installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
