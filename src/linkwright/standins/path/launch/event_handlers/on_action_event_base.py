"""Stands in for ``launch.event_handlers.on_action_event_base``."""

from linkwright.launch.event_handlers import OnActionEventBase

__all__ = ["OnActionEventBase"]
