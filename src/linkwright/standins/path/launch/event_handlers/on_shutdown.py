"""Stands in for ``launch.event_handlers.on_shutdown``."""

from linkwright.launch.event_handlers import OnShutdown

__all__ = ["OnShutdown"]
