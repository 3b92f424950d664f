"""Stands in for ``launch.some_actions_type``, the former name of ``launch.some_entities_type``."""

from linkwright.launch.entity import SomeEntitiesType as SomeActionsType
from linkwright.launch.entity import SomeEntitiesType_types_tuple as SomeActionsType_types_tuple

__all__ = ["SomeActionsType", "SomeActionsType_types_tuple"]
