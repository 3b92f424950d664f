"""Stands in for ``launch.condition``."""

from linkwright.launch.conditions import Condition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Condition"]
