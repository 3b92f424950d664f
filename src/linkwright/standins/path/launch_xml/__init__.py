"""Stands in for ``launch_xml``."""

from linkwright.launch.frontend.xml import Entity, Parser

__all__ = ["Entity", "Parser"]
