"""Stands in for ``launch.substitutions.boolean_substitution``."""

from linkwright.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    NotSubstitution,
    OrSubstitution,
)
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["AllSubstitution", "AndSubstitution", "AnySubstitution", "NotSubstitution", "OrSubstitution"]
