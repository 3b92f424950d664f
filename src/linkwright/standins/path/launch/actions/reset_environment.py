"""Stands in for ``launch.actions.reset_environment``."""

from linkwright.launch.actions import ResetEnvironment

__all__ = ["ResetEnvironment"]
