"""Stands in for ``launch.some_entities_type``."""

from linkwright.launch.entity import SomeEntitiesType, SomeEntitiesType_types_tuple

__all__ = ["SomeEntitiesType", "SomeEntitiesType_types_tuple"]
