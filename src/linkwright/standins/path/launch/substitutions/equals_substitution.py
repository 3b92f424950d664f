"""Stands in for ``launch.substitutions.equals_substitution``."""

from linkwright.launch.substitutions import EqualsSubstitution

__all__ = ["EqualsSubstitution"]
