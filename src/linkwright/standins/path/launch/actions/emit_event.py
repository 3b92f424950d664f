"""Stands in for ``launch.actions.emit_event``."""

from linkwright.launch.actions import EmitEvent
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["EmitEvent"]
