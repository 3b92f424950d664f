"""Stands in for ``launch.actions.execute_local``."""

from linkwright.launch.actions import ExecuteLocal

__all__ = ["ExecuteLocal"]
