"""Stands in for ``launch.substitutions.path_join_substitution``."""

from linkwright.launch.substitutions import PathJoinSubstitution, PathSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PathJoinSubstitution", "PathSubstitution"]
