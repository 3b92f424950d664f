"""Stands in for ``launch.substitutions.environment_variable``."""

from linkwright.launch.substitutions import EnvironmentVariable

__all__ = ["EnvironmentVariable"]
