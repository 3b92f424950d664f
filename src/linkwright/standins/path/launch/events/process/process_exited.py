"""Stands in for ``launch.events.process.process_exited``."""

from linkwright.launch.events import ProcessExited
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessExited"]
