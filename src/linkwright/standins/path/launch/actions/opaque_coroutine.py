"""Stands in for ``launch.actions.opaque_coroutine``."""

from linkwright.launch.actions import OpaqueCoroutine

__all__ = ["OpaqueCoroutine"]
