"""Stands in for ``launch.utilities.class_tools_impl``."""

from linkwright.launch.class_checks import is_a, is_a_subclass, isclassinstance
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["is_a", "is_a_subclass", "isclassinstance"]
