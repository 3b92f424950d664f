"""Stands in for ``launch.action``."""

from linkwright.launch.entity import Action

__all__ = ["Action"]
