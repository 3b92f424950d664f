"""Stands in for ``launch.conditions.unless_condition``."""

from linkwright.launch.conditions import UnlessCondition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["UnlessCondition"]
