"""Stands in for ``launch.conditions.launch_configuration_equals``."""

from linkwright.launch.conditions import LaunchConfigurationEquals

__all__ = ["LaunchConfigurationEquals"]
