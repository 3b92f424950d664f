"""Stands in for ``launch_ros.actions.lifecycle_transition``."""

from linkwright.launch.ros import LifecycleTransition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LifecycleTransition"]
