"""Stands in for ``launch.descriptions``."""

from linkwright.launch.executable import Executable
from linkwright.standins.imported_names import submodules_of

__all__ = ["Executable"]

__getattr__ = submodules_of(__name__)
