"""Stands in for ``launch.some_substitutions_type``."""

from linkwright.launch.substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
