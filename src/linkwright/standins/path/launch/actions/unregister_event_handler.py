"""Stands in for ``launch.actions.unregister_event_handler``."""

from linkwright.launch.actions import UnregisterEventHandler

__all__ = ["UnregisterEventHandler"]
