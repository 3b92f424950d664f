"""Stands in for ``launch.conditions.launch_configuration_equals``."""

from linkwright.launch.conditions import LaunchConfigurationEquals
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchConfigurationEquals"]
