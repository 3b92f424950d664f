"""Stands in for ``launch.actions.unset_environment_variable``."""

from linkwright.launch.actions import UnsetEnvironmentVariable

__all__ = ["UnsetEnvironmentVariable"]
