"""Stands in for ``launch.substitutions.launch_configuration``."""

from linkwright.launch.substitutions import LaunchConfiguration
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LaunchConfiguration"]
