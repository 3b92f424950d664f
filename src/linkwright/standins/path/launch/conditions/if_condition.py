"""Stands in for ``launch.conditions.if_condition``."""

from linkwright.launch.conditions import IfCondition

__all__ = ["IfCondition"]
