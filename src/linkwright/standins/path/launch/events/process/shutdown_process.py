"""Stands in for ``launch.events.process.shutdown_process``."""

from linkwright.launch.events import ShutdownProcess
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ShutdownProcess"]
