"""Stands in for ``launch.conditions.unless_condition``."""

from linkwright.launch.conditions import UnlessCondition

__all__ = ["UnlessCondition"]
