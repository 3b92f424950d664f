"""Stands in for ``launch.actions.opaque_function``."""

from linkwright.launch.actions import OpaqueFunction

__all__ = ["OpaqueFunction"]
