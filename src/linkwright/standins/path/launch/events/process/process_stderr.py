"""Stands in for ``launch.events.process.process_stderr``."""

from linkwright.launch.events import ProcessStderr

__all__ = ["ProcessStderr"]
