"""Stands in for ``launch.substitutions.boolean_substitution``."""

from linkwright.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnySubstitution,
    NotSubstitution,
    OrSubstitution,
)

__all__ = ["AllSubstitution", "AndSubstitution", "AnySubstitution", "NotSubstitution", "OrSubstitution"]
