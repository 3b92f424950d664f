"""Stands in for ``launch.substitutions.for_loop_var``."""

from linkwright.launch.substitutions import ForEachVar, ForLoopIndex
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ForEachVar", "ForLoopIndex"]
