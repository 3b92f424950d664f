"""Stands in for ``launch.event_handlers.on_process_start``."""

from linkwright.launch.event_handlers import OnProcessStart
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnProcessStart"]
