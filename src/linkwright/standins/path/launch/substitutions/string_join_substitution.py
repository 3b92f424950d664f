"""Stands in for ``launch.substitutions.string_join_substitution``."""

from linkwright.launch.substitutions import StringJoinSubstitution

__all__ = ["StringJoinSubstitution"]
