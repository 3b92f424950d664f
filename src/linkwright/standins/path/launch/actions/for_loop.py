"""Stands in for ``launch.actions.for_loop``."""

from linkwright.launch.actions import ForEach, ForLoop
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ForEach", "ForLoop"]
