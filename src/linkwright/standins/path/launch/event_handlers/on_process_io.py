"""Stands in for ``launch.event_handlers.on_process_io``."""

from linkwright.launch.event_handlers import OnProcessIO

__all__ = ["OnProcessIO"]
