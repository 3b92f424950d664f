"""Stands in for ``launch.actions.group_action``."""

from linkwright.launch.actions import GroupAction

__all__ = ["GroupAction"]
