"""Stands in for ``launch.event_handlers.on_process_start``."""

from linkwright.launch.event_handlers import OnProcessStart

__all__ = ["OnProcessStart"]
