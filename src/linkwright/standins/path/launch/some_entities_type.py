"""Stands in for ``launch.some_entities_type``."""

from linkwright.launch.entity import SomeEntitiesType

__all__ = ["SomeEntitiesType"]
