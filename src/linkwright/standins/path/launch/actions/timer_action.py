"""Stands in for ``launch.actions.timer_action``."""

from linkwright.launch.actions import TimerAction
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["TimerAction"]
