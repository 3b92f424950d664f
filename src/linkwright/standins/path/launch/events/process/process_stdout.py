"""Stands in for ``launch.events.process.process_stdout``."""

from linkwright.launch.events import ProcessStdout

__all__ = ["ProcessStdout"]
