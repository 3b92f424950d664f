"""Stands in for ``launch.event_handler``."""

from linkwright.launch.event_handlers import BaseEventHandler, EventHandler
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["BaseEventHandler", "EventHandler"]
