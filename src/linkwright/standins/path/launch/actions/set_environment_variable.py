"""Stands in for ``launch.actions.set_environment_variable``."""

from linkwright.launch.actions import SetEnvironmentVariable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["SetEnvironmentVariable"]
