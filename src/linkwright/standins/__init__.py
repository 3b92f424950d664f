"""Modules that replace those of ROS 2 where these are not installed."""

from linkwright.standins.activation import activate

__all__ = ["activate"]
