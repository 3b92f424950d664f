"""Stands in for ``launch.descriptions``."""

from linkwright.launch.executable import Executable

__all__ = ["Executable"]
