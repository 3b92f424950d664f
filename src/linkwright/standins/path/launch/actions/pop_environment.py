"""Stands in for ``launch.actions.pop_environment``."""

from linkwright.launch.actions import PopEnvironment

__all__ = ["PopEnvironment"]
