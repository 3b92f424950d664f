"""Stands in for ``launch.substitutions.command``."""

from linkwright.launch.substitutions import Command

__all__ = ["Command"]
