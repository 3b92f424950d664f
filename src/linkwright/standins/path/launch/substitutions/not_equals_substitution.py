"""Stands in for ``launch.substitutions.not_equals_substitution``."""

from linkwright.launch.substitutions import NotEqualsSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["NotEqualsSubstitution"]
