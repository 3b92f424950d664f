"""Stands in for ``launch.events.process.process_exited``."""

from linkwright.launch.events import ProcessExited

__all__ = ["ProcessExited"]
