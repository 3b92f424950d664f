"""Stands in for ``launch_ros.actions.node``."""

from linkwright.launch.ros import Node

__all__ = ["Node"]
