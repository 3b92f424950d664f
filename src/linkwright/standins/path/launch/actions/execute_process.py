"""Stands in for ``launch.actions.execute_process``."""

from linkwright.launch.actions import ExecuteProcess

__all__ = ["ExecuteProcess"]
