"""Stands in for ``launch.actions.unset_launch_configuration``."""

from linkwright.launch.actions import UnsetLaunchConfiguration

__all__ = ["UnsetLaunchConfiguration"]
