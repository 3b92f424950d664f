"""Stands in for ``launch.launch_description_entity``."""

from linkwright.launch.entity import LaunchDescriptionEntity
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchDescriptionEntity"]
