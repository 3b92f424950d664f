"""Stands in for ``launch.events.matchers``."""

from linkwright.launch.events import matches_action

__all__ = ["matches_action"]
