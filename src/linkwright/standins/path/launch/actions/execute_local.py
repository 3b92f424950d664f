"""Stands in for ``launch.actions.execute_local``."""

from linkwright.launch.actions import ExecuteLocal
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["ExecuteLocal"]
