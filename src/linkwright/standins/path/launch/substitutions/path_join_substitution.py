"""Stands in for ``launch.substitutions.path_join_substitution``."""

from linkwright.launch.substitutions import PathJoinSubstitution, PathSubstitution

__all__ = ["PathJoinSubstitution", "PathSubstitution"]
