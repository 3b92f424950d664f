"""Stands in for ``launch.events.process.process_matchers``."""

from linkwright.launch.events import matches_executable, matches_name, matches_pid
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["matches_executable", "matches_name", "matches_pid"]
