"""Stands in for ``launch_ros.utilities.lifecycle_event_manager``."""

from linkwright.launch.ros import LifecycleEventManager
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LifecycleEventManager"]
