"""Stands in for ``launch.event_handlers.on_execution_complete``."""

from linkwright.launch.event_handlers import OnExecutionComplete

__all__ = ["OnExecutionComplete"]
