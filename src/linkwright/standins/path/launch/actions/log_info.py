"""Stands in for ``launch.actions.log_info``."""

from linkwright.launch.actions import LogInfo
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["LogInfo"]
