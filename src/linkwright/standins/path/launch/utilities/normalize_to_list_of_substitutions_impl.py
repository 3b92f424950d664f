"""Stands in for ``launch.utilities.normalize_to_list_of_substitutions_impl``."""

from linkwright.launch.substitution import normalize_to_list_of_substitutions

__all__ = ["normalize_to_list_of_substitutions"]
