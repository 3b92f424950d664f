"""Stands in for ``launch.launch_service``."""

from linkwright.launch.service import LaunchService
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchService"]
