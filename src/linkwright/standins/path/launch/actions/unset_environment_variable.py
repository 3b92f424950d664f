"""Stands in for ``launch.actions.unset_environment_variable``."""

from linkwright.launch.actions import UnsetEnvironmentVariable
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["UnsetEnvironmentVariable"]
