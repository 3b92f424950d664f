"""Stands in for ``launch.actions.pop_launch_configurations``."""

from linkwright.launch.actions import PopLaunchConfigurations

__all__ = ["PopLaunchConfigurations"]
