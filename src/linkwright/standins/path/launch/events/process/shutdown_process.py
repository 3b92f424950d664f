"""Stands in for ``launch.events.process.shutdown_process``."""

from linkwright.launch.events import ShutdownProcess

__all__ = ["ShutdownProcess"]
