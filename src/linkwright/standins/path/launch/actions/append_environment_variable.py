"""Stands in for ``launch.actions.append_environment_variable``."""

from linkwright.launch.actions import AppendEnvironmentVariable

__all__ = ["AppendEnvironmentVariable"]
