"""Stands in for ``launch.actions.replace_environment_variables``."""

from linkwright.launch.actions import ReplaceEnvironmentVariables

__all__ = ["ReplaceEnvironmentVariables"]
