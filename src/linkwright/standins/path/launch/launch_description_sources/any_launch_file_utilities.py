"""Stands in for ``launch.launch_description_sources.any_launch_file_utilities``."""

from linkwright.launch.file_utilities import (
    get_launch_description_from_any_launch_file,
    get_launch_description_from_frontend_launch_file,
    get_launch_description_from_python_launch_file,
)
from linkwright.launch.invalid_file import InvalidLaunchFileError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = [
    "InvalidLaunchFileError",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
]
