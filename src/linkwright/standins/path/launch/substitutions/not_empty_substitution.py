"""Stands in for ``launch.substitutions.not_empty_substitution``."""

from linkwright.launch.substitutions import NotEmptySubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["NotEmptySubstitution"]
