"""Stands in for ``launch.events.process.process_stdin``."""

from linkwright.launch.events import ProcessStdin

__all__ = ["ProcessStdin"]
