"""Stands in for ``launch.substitutions.equals_substitution``."""

from linkwright.launch.substitutions import EqualsSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["EqualsSubstitution"]
