"""Stands in for ``launch.substitutions.is_empty_substitution``."""

from linkwright.launch.substitutions import IsEmptySubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["IsEmptySubstitution"]
