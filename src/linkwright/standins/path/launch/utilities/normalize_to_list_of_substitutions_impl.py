"""Stands in for ``launch.utilities.normalize_to_list_of_substitutions_impl``."""

from linkwright.launch.substitution import normalize_to_list_of_substitutions
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["normalize_to_list_of_substitutions"]
