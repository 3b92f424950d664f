"""Stands in for ``launch.substitutions.if_else_substitution``."""

from linkwright.launch.substitutions import IfElseSubstitution

__all__ = ["IfElseSubstitution"]
