"""Stands in for ``launch.substitutions.local_substitution``."""

from linkwright.launch.substitutions import LocalSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LocalSubstitution"]
