"""Stands in for ``launch.launch_description_entity``."""

from linkwright.launch.entity import LaunchDescriptionEntity

__all__ = ["LaunchDescriptionEntity"]
