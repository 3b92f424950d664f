"""Stands in for ``launch.events.process.process_io``."""

from linkwright.launch.events import ProcessIO
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessIO"]
