"""Stands in for ``nav2_common.launch.launch_config_as_bool``."""

from linkwright.launch.rewriting import LaunchConfigAsBool

__all__ = ["LaunchConfigAsBool"]
