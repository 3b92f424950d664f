"""Stands in for ``launch_yaml.launch_description_sources.yaml_launch_description_source``."""

from linkwright.launch.sources import YAMLLaunchDescriptionSource

__all__ = ["YAMLLaunchDescriptionSource"]
