"""Stands in for ``launch.actions.opaque_function``."""

from linkwright.launch.actions import OpaqueFunction
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OpaqueFunction"]
