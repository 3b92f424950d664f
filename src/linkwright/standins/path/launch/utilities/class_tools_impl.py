"""Stands in for ``launch.utilities.class_tools_impl``."""

from linkwright.launch.class_checks import is_a, is_a_subclass, isclassinstance

__all__ = ["is_a", "is_a_subclass", "isclassinstance"]
