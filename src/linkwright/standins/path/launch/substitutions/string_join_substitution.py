"""Stands in for ``launch.substitutions.string_join_substitution``."""

from linkwright.launch.substitutions import StringJoinSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["StringJoinSubstitution"]
