"""Stands in for ``launch.substitutions.find_executable``."""

from linkwright.launch.substitutions import FindExecutable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FindExecutable"]
