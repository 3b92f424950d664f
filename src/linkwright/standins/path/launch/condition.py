"""Stands in for ``launch.condition``."""

from linkwright.launch.conditions import Condition

__all__ = ["Condition"]
