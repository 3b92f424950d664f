"""Stands in for ``launch.event_handler``."""

from linkwright.launch.event_handlers import BaseEventHandler, EventHandler

__all__ = ["BaseEventHandler", "EventHandler"]
