"""Stands in for ``launch_xml.launch_description_sources.xml_launch_description_source``."""

from linkwright.launch.sources import XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
