"""Stands in for ``launch.frontend.parser``."""

from linkwright.launch.frontend.parser import Parser
from linkwright.launch.invalid_file import InvalidFrontendLaunchFileError
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["InvalidFrontendLaunchFileError", "Parser"]
