"""Stands in for ``launch.events.process.process_stdin``."""

from linkwright.launch.events import ProcessStdin
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessStdin"]
