"""Stands in for ``launch.invalid_launch_file_error``."""

from linkwright.launch.invalid_file import InvalidLaunchFileError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["InvalidLaunchFileError"]
