"""Stands in for ``launch_yaml.entity``."""

from linkwright.launch.frontend.yaml import Entity

__all__ = ["Entity"]
