"""Stands in for ``launch.events.execution_complete``."""

from linkwright.launch.events import ExecutionComplete
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ExecutionComplete"]
