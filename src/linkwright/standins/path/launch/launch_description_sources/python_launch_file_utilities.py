"""Stands in for ``launch.launch_description_sources.python_launch_file_utilities``."""

from linkwright.launch.file_utilities import (
    get_launch_description_from_python_launch_file,
    load_python_launch_file_as_module,
)
from linkwright.launch.invalid_file import InvalidPythonLaunchFileError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = [
    "InvalidPythonLaunchFileError",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]
