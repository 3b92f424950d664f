"""Stands in for ``launch_xml.entity``."""

from linkwright.launch.frontend.xml import Entity

__all__ = ["Entity"]
