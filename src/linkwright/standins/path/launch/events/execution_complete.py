"""Stands in for ``launch.events.execution_complete``."""

from linkwright.launch.events import ExecutionComplete

__all__ = ["ExecutionComplete"]
