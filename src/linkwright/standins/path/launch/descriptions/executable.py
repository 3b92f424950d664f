"""Stands in for ``launch.descriptions.executable``."""

from linkwright.launch.executable import Executable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Executable"]
