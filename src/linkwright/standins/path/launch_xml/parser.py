"""Stands in for ``launch_xml.parser``."""

from linkwright.launch.frontend.xml import Parser

__all__ = ["Parser"]
