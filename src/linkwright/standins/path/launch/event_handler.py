"""Stands in for ``launch.event_handler``."""

from linkwright.launch.event_handlers import EventHandler

__all__ = ["EventHandler"]
