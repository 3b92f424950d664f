"""Stands in for ``launch.actions.reset_launch_configurations``."""

from linkwright.launch.actions import ResetLaunchConfigurations

__all__ = ["ResetLaunchConfigurations"]
