"""Stands in for ``launch_xml.launch_description_sources``."""

from linkwright.launch.sources import XMLLaunchDescriptionSource

__all__ = ["XMLLaunchDescriptionSource"]
