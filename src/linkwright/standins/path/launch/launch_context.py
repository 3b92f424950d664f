"""Stands in for ``launch.launch_context``."""

from linkwright.launch.context import LaunchContext
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchContext"]
