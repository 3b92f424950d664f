"""Stands in for ``launch.conditions.if_condition``."""

from linkwright.launch.conditions import IfCondition
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["IfCondition"]
