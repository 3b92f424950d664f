"""Stands in for ``launch_ros.remap_rule_type``."""

from collections.abc import Iterable, Sequence

from launch.some_substitutions_type import SomeSubstitutionsType
from launch.substitution import Substitution

from linkwright.standins.launch_names import imported_there as __getattr__

SomeRemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]
SomeRemapRules = Iterable[SomeRemapRule]
RemapRule = tuple[Sequence[Substitution], Sequence[Substitution]]
RemapRules = Sequence[RemapRule]

__all__ = ["RemapRule", "RemapRules", "SomeRemapRule", "SomeRemapRules"]
