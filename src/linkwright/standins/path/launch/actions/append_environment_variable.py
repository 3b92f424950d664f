"""Stands in for ``launch.actions.append_environment_variable``."""

from linkwright.launch.actions import AppendEnvironmentVariable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["AppendEnvironmentVariable"]
