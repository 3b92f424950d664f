"""Stands in for ``launch.events``."""

from launch.events import process
from linkwright.launch.events import ExecutionComplete, Shutdown, TimerEvent, matches_action

__all__ = ["ExecutionComplete", "Shutdown", "TimerEvent", "matches_action"]
