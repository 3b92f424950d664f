"""Stands in for ``launch.descriptions.executable``."""

from linkwright.launch.executable import Executable

__all__ = ["Executable"]
