"""Stands in for ``launch.events.process.process_matchers``."""

from linkwright.launch.events import matches_executable, matches_name, matches_pid

__all__ = ["matches_executable", "matches_name", "matches_pid"]
