"""Stands in for ``launch.launch_description_sources.frontend_launch_description_source``."""

from linkwright.launch.sources import FrontendLaunchDescriptionSource
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FrontendLaunchDescriptionSource"]
