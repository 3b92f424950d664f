"""Stands in for ``launch.substitutions.launch_configuration``."""

from linkwright.launch.substitutions import LaunchConfiguration

__all__ = ["LaunchConfiguration"]
