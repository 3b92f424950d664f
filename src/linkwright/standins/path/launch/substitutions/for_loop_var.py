"""Stands in for ``launch.substitutions.for_loop_var``."""

from linkwright.launch.substitutions import ForEachVar, ForLoopIndex

__all__ = ["ForEachVar", "ForLoopIndex"]
