"""Stands in for ``launch.some_substitutions_type``."""

from linkwright.launch.substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]
