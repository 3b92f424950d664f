"""Stands in for ``launch.actions.reset_launch_configurations``."""

from linkwright.launch.actions import ResetLaunchConfigurations
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ResetLaunchConfigurations"]
