"""Stands in for ``launch.utilities.normalize_to_list_of_entities_impl``."""

from linkwright.launch.entity import as_entities as normalize_to_list_of_entities

__all__ = ["normalize_to_list_of_entities"]
