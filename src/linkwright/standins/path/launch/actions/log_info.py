"""Stands in for ``launch.actions.log_info``."""

from linkwright.launch.actions import LogInfo

__all__ = ["LogInfo"]
