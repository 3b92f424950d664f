"""Stands in for ``launch.utilities.perform_substitutions_impl``."""

from linkwright.launch.substitution import perform_substitutions
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["perform_substitutions"]
