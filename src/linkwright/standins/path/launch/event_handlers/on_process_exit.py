"""Stands in for ``launch.event_handlers.on_process_exit``."""

from linkwright.launch.event_handlers import OnProcessExit

__all__ = ["OnProcessExit"]
