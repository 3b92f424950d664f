"""Linkwright: a robot-description workbench without ROS."""

from linkwright._version import __version__

__all__ = ["__version__"]
