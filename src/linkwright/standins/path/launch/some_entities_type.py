"""Stands in for ``launch.some_entities_type``."""

from linkwright.launch.entity import SomeEntitiesType, SomeEntitiesType_types_tuple
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SomeEntitiesType", "SomeEntitiesType_types_tuple"]
