"""Stands in for ``launch.invalid_launch_file_error``."""

from linkwright.launch.invalid_file import InvalidLaunchFileError

__all__ = ["InvalidLaunchFileError"]
