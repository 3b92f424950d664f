"""Stands in for ``launch.actions.push_environment``."""

from linkwright.launch.actions import PushEnvironment

__all__ = ["PushEnvironment"]
