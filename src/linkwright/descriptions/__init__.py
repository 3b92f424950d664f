"""Read files or unsaved texts as robots and worlds, and report all findings."""

from linkwright.descriptions.service import (
    Description,
    DescriptionLibrary,
    Packages,
    WorldDescription,
    examine,
    examine_world,
    is_world,
    is_xacro,
    load,
)
from linkwright.diagnostics.diagnostic import TEXT_NAME

__all__ = [
    "TEXT_NAME",
    "Description",
    "DescriptionLibrary",
    "Packages",
    "WorldDescription",
    "examine",
    "examine_world",
    "is_world",
    "is_xacro",
    "load",
]
