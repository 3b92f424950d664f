"""Stands in for ``launch_ros.event_handlers.on_state_transition``."""

from linkwright.launch.ros import OnStateTransition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OnStateTransition"]
