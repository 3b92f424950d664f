"""Stands in for ``launch.events.process.process_io``."""

from linkwright.launch.events import ProcessIO

__all__ = ["ProcessIO"]
