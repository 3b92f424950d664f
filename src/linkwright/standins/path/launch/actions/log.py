"""Stands in for ``launch.actions.log``."""

from linkwright.launch.actions import Log, LogDebug, LogError, LogInfo, LogWarning

__all__ = ["Log", "LogDebug", "LogError", "LogInfo", "LogWarning"]
