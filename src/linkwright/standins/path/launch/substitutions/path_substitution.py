"""Stands in for ``launch.substitutions.path_substitution``."""

from linkwright.launch.substitutions import PathSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PathSubstitution"]
