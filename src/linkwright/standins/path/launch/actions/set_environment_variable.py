"""Stands in for ``launch.actions.set_environment_variable``."""

from linkwright.launch.actions import SetEnvironmentVariable

__all__ = ["SetEnvironmentVariable"]
