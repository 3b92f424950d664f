"""Stands in for ``launch.actions.execute_process``."""

from linkwright.launch.actions import ExecuteProcess
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ExecuteProcess"]
