"""Stands in for ``launch.substitutions.not_empty_substitution``."""

from linkwright.launch.substitutions import NotEmptySubstitution

__all__ = ["NotEmptySubstitution"]
