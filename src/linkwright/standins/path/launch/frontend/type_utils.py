"""Stands in for ``launch.frontend.type_utils``."""

from linkwright.launch.frontend.entity import is_list_of_entities as check_is_list_entity
from linkwright.launch.frontend.values import get_data_type_from_identifier
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["check_is_list_entity", "get_data_type_from_identifier"]
