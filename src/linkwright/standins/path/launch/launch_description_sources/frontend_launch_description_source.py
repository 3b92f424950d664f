"""Stands in for ``launch.launch_description_sources.frontend_launch_description_source``."""

from linkwright.launch.sources import FrontendLaunchDescriptionSource

__all__ = ["FrontendLaunchDescriptionSource"]
