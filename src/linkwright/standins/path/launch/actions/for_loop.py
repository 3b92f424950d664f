"""Stands in for ``launch.actions.for_loop``."""

from linkwright.launch.actions import ForEach, ForLoop

__all__ = ["ForEach", "ForLoop"]
