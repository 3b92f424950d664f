"""Stands in for ``launch_yaml.launch_description_sources``."""

from linkwright.launch.sources import YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
