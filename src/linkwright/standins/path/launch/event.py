"""Stands in for ``launch.event``."""

from linkwright.launch.events import Event

__all__ = ["Event"]
