"""The file formats with their own language features.

Other XML files are treated as descriptions.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.language.cmake_files import CMAKE_FILES
from linkwright.language.format import Format
from linkwright.language.interfaces import INTERFACES
from linkwright.language.launch_python import LAUNCH_PYTHON
from linkwright.language.launch_xml import LAUNCH_XML
from linkwright.language.launch_yaml import LAUNCH_YAML
from linkwright.language.manifest import PACKAGE_XML
from linkwright.language.parameter_files import PARAMETER_FILES
from linkwright.language.rviz_files import RVIZ_FILES
from linkwright.language.setup_files import SETUP_FILES
from linkwright.language.srdf import SRDF_FILES

FORMATS: tuple[Format, ...] = (
    LAUNCH_XML,
    LAUNCH_PYTHON,
    LAUNCH_YAML,
    INTERFACES,
    PACKAGE_XML,
    SRDF_FILES,
    PARAMETER_FILES,
    RVIZ_FILES,
    CMAKE_FILES,
    SETUP_FILES,
)
"""The formats, in order of precedence."""


def format_of(file: Path) -> Format | None:
    """Return the first format that covers a path, or None if no format does."""
    return next((file_format for file_format in FORMATS if file_format.covers(file)), None)
