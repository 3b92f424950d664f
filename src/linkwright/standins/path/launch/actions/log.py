"""Stands in for ``launch.actions.log``."""

from linkwright.launch.actions import Log, LogDebug, LogError, LogInfo, LogWarning
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["Log", "LogDebug", "LogError", "LogInfo", "LogWarning"]
