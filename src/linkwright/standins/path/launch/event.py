"""Stands in for ``launch.event``."""

from linkwright.launch.events import Event
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Event"]
