"""Stands in for ``launch.conditions.launch_configuration_not_equals``."""

from linkwright.launch.conditions import LaunchConfigurationNotEquals
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchConfigurationNotEquals"]
