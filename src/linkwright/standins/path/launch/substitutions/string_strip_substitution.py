"""Stands in for ``launch.substitutions.string_strip_substitution``."""

from linkwright.launch.substitutions import StringStripSubstitution

__all__ = ["StringStripSubstitution"]
