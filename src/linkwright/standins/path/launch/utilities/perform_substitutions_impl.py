"""Stands in for ``launch.utilities.perform_substitutions_impl``."""

from linkwright.launch.substitution import perform_substitutions

__all__ = ["perform_substitutions"]
