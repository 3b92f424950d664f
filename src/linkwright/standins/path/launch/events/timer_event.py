"""Stands in for ``launch.events.timer_event``."""

from linkwright.launch.events import TimerEvent

__all__ = ["TimerEvent"]
