"""Stands in for ``launch_ros.events.lifecycle.change_state``."""

from linkwright.launch.ros import ChangeState
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ChangeState"]
