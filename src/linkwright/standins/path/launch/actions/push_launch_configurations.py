"""Stands in for ``launch.actions.push_launch_configurations``."""

from linkwright.launch.actions import PushLaunchConfigurations
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PushLaunchConfigurations"]
