"""Stands in for ``launch.launch_description_sources.frontend_launch_file_utilities``."""

from linkwright.launch.file_utilities import get_launch_description_from_frontend_launch_file
from linkwright.launch.invalid_file import InvalidFrontendLaunchFileError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["InvalidFrontendLaunchFileError", "get_launch_description_from_frontend_launch_file"]
