"""Stands in for ``launch.substitution``."""

from linkwright.launch.substitution import Substitution
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Substitution"]
