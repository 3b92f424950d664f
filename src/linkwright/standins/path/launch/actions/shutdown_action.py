"""Stands in for ``launch.actions.shutdown_action``."""

from linkwright.launch.actions import Shutdown
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Shutdown"]
