"""Stands in for ``launch.utilities.ensure_argument_type_impl``."""

from linkwright.launch.class_checks import ensure_argument_type

__all__ = ["ensure_argument_type"]
