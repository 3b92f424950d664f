"""Stands in for ``launch.utilities``."""

from launch.utilities import type_utils
from linkwright.launch.class_checks import (
    create_future,
    ensure_argument_type,
    is_a,
    is_a_subclass,
    isclassinstance,
    visit_all_entities_and_collect_futures,
)
from linkwright.launch.entity import as_entities as normalize_to_list_of_entities
from linkwright.launch.signal_manager import AsyncSafeSignalManager
from linkwright.launch.substitution import normalize_to_list_of_substitutions, perform_substitutions
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "AsyncSafeSignalManager",
    "create_future",
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "isclassinstance",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "type_utils",
    "visit_all_entities_and_collect_futures",
]

__getattr__ = submodules_of(__name__)
