"""Stands in for ``launch.events.process.process_stderr``."""

from linkwright.launch.events import ProcessStderr
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessStderr"]
