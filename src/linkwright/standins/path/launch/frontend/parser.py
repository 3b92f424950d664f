"""Stands in for ``launch.frontend.parser``."""

from linkwright.launch.frontend.parser import Parser
from linkwright.launch.invalid_file import InvalidFrontendLaunchFileError

__all__ = ["InvalidFrontendLaunchFileError", "Parser"]
