"""Stands in for ``launch.substitutions.environment_variable``."""

from linkwright.launch.substitutions import EnvironmentVariable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["EnvironmentVariable"]
