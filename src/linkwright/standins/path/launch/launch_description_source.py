"""Stands in for ``launch.launch_description_source``."""

from linkwright.launch.sources import LaunchDescriptionSource
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchDescriptionSource"]
