"""Stands in for ``launch.actions.opaque_coroutine``."""

from linkwright.launch.actions import OpaqueCoroutine
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["OpaqueCoroutine"]
