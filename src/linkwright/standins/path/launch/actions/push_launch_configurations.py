"""Stands in for ``launch.actions.push_launch_configurations``."""

from linkwright.launch.actions import PushLaunchConfigurations

__all__ = ["PushLaunchConfigurations"]
