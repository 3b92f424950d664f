"""Stands in for ``launch.substitutions.not_equals_substitution``."""

from linkwright.launch.substitutions import NotEqualsSubstitution

__all__ = ["NotEqualsSubstitution"]
