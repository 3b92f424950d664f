"""Stands in for ``launch.substitutions.is_empty_substitution``."""

from linkwright.launch.substitutions import IsEmptySubstitution

__all__ = ["IsEmptySubstitution"]
