"""Stands in for ``launch.events.process.running_process_event``."""

from linkwright.launch.events import RunningProcessEvent
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["RunningProcessEvent"]
