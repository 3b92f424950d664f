"""Stands in for ``launch.substitutions.find_launchfile``."""

from linkwright.launch.substitutions import FindLaunchfile
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FindLaunchfile"]
