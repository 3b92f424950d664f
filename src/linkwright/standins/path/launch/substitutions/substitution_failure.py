"""Stands in for ``launch.substitutions.substitution_failure``."""

from linkwright.launch.substitution import SubstitutionFailure

__all__ = ["SubstitutionFailure"]
