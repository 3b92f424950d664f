"""Stands in for ``launch.launch_description_sources.any_launch_description_source``."""

from linkwright.launch.sources import AnyLaunchDescriptionSource

__all__ = ["AnyLaunchDescriptionSource"]
