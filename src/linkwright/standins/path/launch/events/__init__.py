"""Stands in for ``launch.events``."""

from launch.events import process
from linkwright.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown, TimerEvent, matches_action
from linkwright.standins.imported_names import submodules_of

__all__ = ["ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent", "matches_action", "process"]

__getattr__ = submodules_of(__name__)
