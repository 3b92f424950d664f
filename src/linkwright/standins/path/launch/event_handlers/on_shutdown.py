"""Stands in for ``launch.event_handlers.on_shutdown``."""

from linkwright.launch.event_handlers import OnShutdown
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnShutdown"]
