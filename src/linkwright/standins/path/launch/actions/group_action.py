"""Stands in for ``launch.actions.group_action``."""

from linkwright.launch.actions import GroupAction
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["GroupAction"]
