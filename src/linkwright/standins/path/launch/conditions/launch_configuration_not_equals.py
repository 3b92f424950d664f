"""Stands in for ``launch.conditions.launch_configuration_not_equals``."""

from linkwright.launch.conditions import LaunchConfigurationNotEquals

__all__ = ["LaunchConfigurationNotEquals"]
