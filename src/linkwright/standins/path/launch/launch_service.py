"""Stands in for ``launch.launch_service``."""

from linkwright.launch.service import LaunchService

__all__ = ["LaunchService"]
