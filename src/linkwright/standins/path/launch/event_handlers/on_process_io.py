"""Stands in for ``launch.event_handlers.on_process_io``."""

from linkwright.launch.event_handlers import OnProcessIO
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnProcessIO"]
