"""Stands in for ``launch.actions.replace_environment_variables``."""

from linkwright.launch.actions import ReplaceEnvironmentVariables
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ReplaceEnvironmentVariables"]
