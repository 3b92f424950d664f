"""Stands in for ``launch.event_handlers.on_action_event_base``."""

from linkwright.launch.event_handlers import OnActionEventBase
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnActionEventBase"]
