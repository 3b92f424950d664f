"""Stands in for ``launch.utilities.create_future_impl``."""

from linkwright.launch.class_checks import create_future
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["create_future"]
