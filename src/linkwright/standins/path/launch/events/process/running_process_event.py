"""Stands in for ``launch.events.process.running_process_event``."""

from linkwright.launch.events import RunningProcessEvent

__all__ = ["RunningProcessEvent"]
