"""Stands in for ``launch.substitutions.path_substitution``."""

from linkwright.launch.substitutions import PathSubstitution

__all__ = ["PathSubstitution"]
