"""Stands in for ``launch.launch_description_sources``."""

from launch.launch_description_sources.any_launch_file_utilities import get_launch_description_from_any_launch_file
from launch.launch_description_sources.frontend_launch_file_utilities import (
    get_launch_description_from_frontend_launch_file,
)
from launch.launch_description_sources.python_launch_file_utilities import (
    get_launch_description_from_python_launch_file,
    load_python_launch_file_as_module,
)
from linkwright.launch.invalid_file import InvalidFrontendLaunchFileError, InvalidPythonLaunchFileError
from linkwright.launch.sources import (
    AnyLaunchDescriptionSource,
    FrontendLaunchDescriptionSource,
    PythonLaunchDescriptionSource,
)
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidFrontendLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]

__getattr__ = submodules_of(__name__)
