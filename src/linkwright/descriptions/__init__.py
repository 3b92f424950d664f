"""The one way from a file, or a text that is not saved yet, to a robot, its origins and its findings."""

from linkwright.descriptions.description import TEXT_NAME, Description
from linkwright.descriptions.library import DescriptionLibrary
from linkwright.descriptions.service import Packages, examine, is_xacro, load

__all__ = ["TEXT_NAME", "Description", "DescriptionLibrary", "Packages", "examine", "is_xacro", "load"]
