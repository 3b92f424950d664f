"""Stands in for ``launch.substitutions.text_substitution``."""

from linkwright.launch.substitution import TextSubstitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["TextSubstitution"]
