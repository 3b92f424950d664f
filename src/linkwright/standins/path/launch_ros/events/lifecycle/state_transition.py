"""Stands in for ``launch_ros.events.lifecycle.state_transition``."""

from linkwright.launch.ros import StateTransition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["StateTransition"]
