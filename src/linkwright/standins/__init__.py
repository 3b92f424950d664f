"""Modules that stand in for those of ROS 2 where these are not installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
