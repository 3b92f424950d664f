"""Stands in for ``launch.utilities.normalize_to_list_of_entities_impl``."""

from linkwright.launch.entity import as_entities as normalize_to_list_of_entities
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["normalize_to_list_of_entities"]
