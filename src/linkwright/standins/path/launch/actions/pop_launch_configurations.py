"""Stands in for ``launch.actions.pop_launch_configurations``."""

from linkwright.launch.actions import PopLaunchConfigurations
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PopLaunchConfigurations"]
