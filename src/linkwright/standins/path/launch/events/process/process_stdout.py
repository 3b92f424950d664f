"""Stands in for ``launch.events.process.process_stdout``."""

from linkwright.launch.events import ProcessStdout
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ProcessStdout"]
