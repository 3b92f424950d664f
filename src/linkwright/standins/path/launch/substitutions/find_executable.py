"""Stands in for ``launch.substitutions.find_executable``."""

from linkwright.launch.substitutions import FindExecutable

__all__ = ["FindExecutable"]
