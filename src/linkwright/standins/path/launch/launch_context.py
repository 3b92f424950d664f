"""Stands in for ``launch.launch_context``."""

from linkwright.launch.context import LaunchContext

__all__ = ["LaunchContext"]
