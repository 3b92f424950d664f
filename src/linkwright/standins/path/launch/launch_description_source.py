"""Stands in for ``launch.launch_description_source``."""

from linkwright.launch.sources import LaunchDescriptionSource

__all__ = ["LaunchDescriptionSource"]
