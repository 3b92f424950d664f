"""Stands in for ``launch.actions.unregister_event_handler``."""

from linkwright.launch.actions import UnregisterEventHandler
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["UnregisterEventHandler"]
