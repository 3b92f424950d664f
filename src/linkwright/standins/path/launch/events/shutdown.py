"""Stands in for ``launch.events.shutdown``."""

from linkwright.launch.events import Shutdown
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Shutdown"]
