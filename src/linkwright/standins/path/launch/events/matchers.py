"""Stands in for ``launch.events.matchers``."""

from linkwright.launch.events import matches_action
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["matches_action"]
