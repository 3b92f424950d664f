"""Stands in for ``launch.frontend``."""

from launch.frontend import type_utils
from launch.frontend.parse_substitution import parse_if_substitutions, parse_substitution
from linkwright.launch.frontend.entity import Entity
from linkwright.launch.frontend.expose import expose_action, expose_substitution
from linkwright.launch.frontend.parser import Parser
from linkwright.launch.invalid_file import InvalidFrontendLaunchFileError
from linkwright.standins.imported_names import submodules_of

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "parse_if_substitutions",
    "parse_substitution",
    "type_utils",
]

__getattr__ = submodules_of(__name__)
