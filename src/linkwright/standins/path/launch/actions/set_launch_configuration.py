"""Stands in for ``launch.actions.set_launch_configuration``."""

from linkwright.launch.actions import SetLaunchConfiguration

__all__ = ["SetLaunchConfiguration"]
