"""Stands in for ``launch.actions.register_event_handler``."""

from linkwright.launch.actions import RegisterEventHandler

__all__ = ["RegisterEventHandler"]
