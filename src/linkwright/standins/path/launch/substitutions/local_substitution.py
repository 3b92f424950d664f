"""Stands in for ``launch.substitutions.local_substitution``."""

from linkwright.launch.substitutions import LocalSubstitution

__all__ = ["LocalSubstitution"]
