"""Stands in for ``launch.actions.emit_event``."""

from linkwright.launch.actions import EmitEvent

__all__ = ["EmitEvent"]
