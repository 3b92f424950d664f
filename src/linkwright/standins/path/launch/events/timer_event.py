"""Stands in for ``launch.events.timer_event``."""

from linkwright.launch.events import TimerEvent
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["TimerEvent"]
