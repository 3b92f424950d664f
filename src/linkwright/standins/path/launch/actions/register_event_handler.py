"""Stands in for ``launch.actions.register_event_handler``."""

from linkwright.launch.actions import RegisterEventHandler
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["RegisterEventHandler"]
