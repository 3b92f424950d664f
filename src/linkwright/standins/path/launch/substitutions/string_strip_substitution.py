"""Stands in for ``launch.substitutions.string_strip_substitution``."""

from linkwright.launch.substitutions import StringStripSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["StringStripSubstitution"]
