"""Modules that stand in for ROS 2 modules that are not installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
