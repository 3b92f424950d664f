"""Stands in for ``launch.substitutions.substitution_failure``."""

from linkwright.launch.substitution import SubstitutionFailure
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SubstitutionFailure"]
