"""Stands in for ``launch.utilities.ensure_argument_type_impl``."""

from linkwright.launch.class_checks import ensure_argument_type
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ensure_argument_type"]
