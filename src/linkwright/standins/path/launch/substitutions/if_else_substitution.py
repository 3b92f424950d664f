"""Stands in for ``launch.substitutions.if_else_substitution``."""

from linkwright.launch.substitutions import IfElseSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["IfElseSubstitution"]
