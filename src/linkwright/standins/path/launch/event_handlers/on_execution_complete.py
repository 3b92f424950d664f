"""Stands in for ``launch.event_handlers.on_execution_complete``."""

from linkwright.launch.event_handlers import OnExecutionComplete
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnExecutionComplete"]
