"""Stands in for ``launch_ros.event_handlers``."""

from linkwright.launch.ros import OnStateTransition
from linkwright.standins.imported_names import submodules_of

__all__ = ["OnStateTransition"]

__getattr__ = submodules_of(__name__)
