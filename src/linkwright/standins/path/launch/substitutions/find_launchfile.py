"""Stands in for ``launch.substitutions.find_launchfile``."""

from linkwright.launch.substitutions import FindLaunchfile

__all__ = ["FindLaunchfile"]
